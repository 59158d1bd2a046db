#pragma once

#include <string>
#include <vector>

#include "output/json.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

/// A record of velocity steps or holds and its rate-and-state friction, for all kinds of text and page.

/// "10 um/s", "2.5 mm/s": in the unit in which it is no small part of one.
std::string sliding_speed_text(double speed);
/// Load point, normal stress, v0 and the line that is taken off.
Facts load_point_facts(const Motion& motion, const RateStateAnalysis* analysis);
/// Laws, which of them, each step, holds.
void add_rate_state(const RateStateAnalysis& analysis, const Motion& motion, ReportSection& section);
/// The best fit in a sentence, and whether the machine can stick and slip.
std::string verdict_on(const RateStateAnalysis& analysis);
/// Friction over the displacement of the load point beside the model, the steps one by one, and the healing.
std::vector<Chart> rate_state_charts(const RateStateAnalysis& analysis);

/// The laws in the shape of all fits, and all that is said of steps and holds.
Json rate_state_fits_json(const RateStateAnalysis& analysis, const Motion& motion);
Json rate_state_json(const RateStateAnalysis& analysis, const Motion& motion);

}  // namespace tribofit
