#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace tribofit {

/// Logarithm of a density, up to a constant; minus infinity where there is none. Anything that is not a number counts
/// as that.
using LogDensity = std::function<double(const std::vector<double>&)>;

/// Points drawn from a density of any shape: each walker steps along the line to another one, so that scales and
/// correlations need not be known (J. Goodman, J. Weare, Comm. App. Math. Comp. Sci. 5 (2010) 65,
/// doi:10.2140/camcos.2010.5.65).
///
/// start: one point for each walker, an even number of them and more than twice the dimension, not all in one plane;
/// where the density is nowhere positive they are returned as they are. The first `discarded` rounds are not kept, of
/// the next `kept` all walkers are. The same for the same seed. Cost: an evaluation for each walker and round.
std::vector<std::vector<double>> sample_ensemble(const LogDensity& density, std::vector<std::vector<double>> start,
                                                 std::size_t discarded, std::size_t kept, std::uint64_t seed);

}  // namespace tribofit
