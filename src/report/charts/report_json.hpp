#pragma once

#include "report/json_parts.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

/// A report as the page takes it: its members under their own names, those that have their default value left out,
/// numbers with no more digits than are drawn.
Json report_json(const Report& report);

}  // namespace tribofit
