#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/ingest/instruments.hpp"

namespace tribofit::diagnosis {

/// How the rule of evidence decides between a few effects beside a model: what a diagnosis would name if nothing else
/// were in the catalogue.
struct Ruling {
  struct OfEffect {
    std::string spelled;
    bool passes = false;  ///< it would be named if it were alone
    double p_value = 1;   ///< corrected for the whole catalogue
    double fall = 0;      ///< of the held-out squares, over the noise of a difference
    /// Held-out squares more than the best of those that pass, over the noise of a difference. Two models are
    /// distinguishable from limits::kDistinguishable and `least_by_size` on; with the right one known it is normal with
    /// the variance four times its mean.
    double behind = 0;
  };
  double least_by_size = 0;           ///< in the same unit, for these records: longer ones ask for more in proportion
  std::vector<OfEffect> effects;      ///< as asked; those that cannot act on the model, or that these data cannot show,
                                      ///< pass never
  std::optional<std::size_t> leader;  ///< of those
  std::vector<std::size_t> group;     ///< that are not distinguishable from the leader

  bool names_alone(std::size_t effect) const { return leader == effect && group.empty(); }
};

/// beside: effects that stand beside the law in every model. Throws Stopped.
Ruling rule_between(std::span<const Record> records, const Law& law, const std::vector<Effect>& beside,
                    const std::vector<Effect>& effects, const Instruments& instruments = {});

}  // namespace tribofit::diagnosis
