#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "trial.hpp"
#include "tribofit/fit/fit.hpp"

namespace tribofit::diagnosis {

inline constexpr std::size_t kAllEffects = std::numeric_limits<std::size_t>::max();

/// Another law with the effects of a trial but one, at low resolution; not usable where an effect cannot act on it.
Trial try_other_law(const DiagnosisContext& context, const Law& law, const Trial& known,
                    std::size_t without = kAllEffects);

/// Of `laws` those that these data do not distinguish from the law of a fitted model: with the same effects they
/// predict held-out cycles as well, by the comparison that `identify` makes of two laws. top: the model at low
/// resolution, fitted: as it is reported.
std::vector<Law> rival_laws(const DiagnosisContext& context, const std::vector<Law>& laws, const Trial& top,
                            const Fit& fitted, const Instruments& instruments, const FitOptions& options);

}  // namespace tribofit::diagnosis
