#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tribofit/campaign/pool.hpp"
#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// Values of repeats together, as [D] has them in Fig 5 to 9: plain means over the runs of a group.

/// The pooled value of that name of the base law or a measure; null where there is none.
const PooledValue* pooled_value(const std::vector<PooledValue>& values, std::string_view name);

/// Its plain mean with the standard error; nothing where there is none.
std::optional<Estimate> pooled_mean(const std::vector<PooledValue>& values, std::string_view name);

/// Fits of a group with this law and protocol; null where there are none.
const PooledGroup::OfFit* fit_of(const PooledGroup& group, std::string_view law, std::string_view protocol);

/// mu_s - mu_k over the runs of a group: mean and standard error, as [D] Fig 9 has its means; not known for a
/// law without these levels.
Estimate drop_of(std::span<const RunResult> runs, const PooledGroup& group, const PooledGroup::OfFit& pooled);

/// Amplitude of the fundamental of v_r over the runs of a group [mm/s]; none where no run has figures.
std::optional<Estimate> fundamental_of(const ResultReader& results, std::span<const RunResult> runs,
                                       const PooledGroup& group);

/// What the figures of one run show.
struct FiguresOfRun {
  std::string run;  ///< its name
  RunFigures figures;
};

/// The first run of a group that has figures; nothing where none has.
std::optional<FiguresOfRun> first_figures(const ResultReader& results, std::span<const RunResult> runs,
                                          const PooledGroup& group);

/// The laws that any group has by the joint protocol, in the order in which they are met.
std::vector<std::string> joint_laws(std::span<const PooledGroup> groups);

/// A parameter of a law that is no level: neither mu_s nor mu_k, nor of an effect.
struct OtherParameter {
  std::string law, name, unit;
};
/// Those that any group has, in the order in which they are met.
std::vector<OtherParameter> other_parameters(std::span<const PooledGroup> groups);

/// Law and protocol of each estimate of the levels mu_s and mu_k; per-cycle extremes give the same whatever the law.
std::vector<std::pair<std::string, std::string>> kinds_of_levels(std::span<const PooledGroup> groups);

}  // namespace tribofit
