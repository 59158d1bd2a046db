#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "instrument_limits.hpp"
#include "tribofit/fit/fit.hpp"

namespace tribofit::diagnosis {

/// One effect that may explain the error.
struct Candidate {
  Effect effect;
  EffectInfo info;
  std::string untestable;                    ///< why these data cannot show it; empty where they can
  std::optional<AllowedRange> allowed = {};  ///< beside what the instruments file declares
};

/// Every effect of the catalogue with its forms (of the same key) and the user's own, each checked for its channels and
/// for what excites it, and bounded by what the instruments file declares.
/// Effects of the motion are left out: kinematics/ answers for them.
std::vector<Candidate> candidates(std::span<const Record> records, const Observations& observations,
                                  const std::vector<Effect>& own, const Instruments& instruments = {});

/// Why a record with so few revolutions of the disc cannot show an effect.
std::string too_few_revolutions(double recorded, const EffectInfo& info);

/// Where a search for the parameters of an effect must begin [SI], and in how many places independent of one another it
/// looked before (for the correction of p-values).
struct Starts {
  std::vector<std::vector<double>> values;
  double places = 1;
};

/// Enough slips lie on either side of a change of friction at `time` [s] to know both levels.
bool is_amid_slips(const Observations& observations, double time);

/// `residual` is what the model so far leaves: one value for each of the observations.
Starts starts_of(const Candidate& candidate, std::span<const Record> records, const Observations& observations,
                 std::span<const double> residual);

}  // namespace tribofit::diagnosis
