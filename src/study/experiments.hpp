#pragma once

#include <vector>

#include "open_question.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// Those of the record that the runs go on from.
RunConditions conditions_of_record(const OpenQuestion& question, const Identification& trace);

/// Every experiment that the means allow about a question.
std::vector<Experiment> experiments_for(const OpenQuestion& question, const Identification& trace, const Means& means);

/// The means of a person who said nothing of them.
Means usual_means(const Identification& trace, double longest);

}  // namespace tribofit
