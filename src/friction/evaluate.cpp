#include "tribofit/friction/evaluate.hpp"

namespace tribofit {

template LawValues<double> law_for(const FrictionModel&, const double*, const Slip&);
template double steady_friction(const FrictionModel&, const double*, const LawValues<double>&, SlidingState<double>,
                                const double*);
template void steady_friction(const FrictionModel&, const double*, const LawValues<double>&, const Slip&,
                              std::span<const double>, std::span<double>);
template double break_away_level(const FrictionModel&, const double*, const Slip&);
template void evaluate(const FrictionModel&, const double*, const Slip&, std::span<const double>, std::span<double>);

}  // namespace tribofit
