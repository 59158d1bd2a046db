#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "terminal_text.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

struct Motion;

/// What is said of a record before any law, on a terminal and on a page alike.

/// Names and values, as people read them.
using Facts = std::vector<std::pair<std::string, std::string>>;

/// "100 000 samples, 5.000 s at 20 kHz".
std::string record_sentence(const Identification& record);

/// Radius, disc speed and load with where each comes from: {"radius", "15 mm (command line)"}.
Facts condition_facts(const Motion& motion);

/// Cycles, frequency, amplitude, stick and slip time, branches, RMS.
Facts stick_slip_facts(const Identification& record);

/// Checks, the worst first; with the trace each belongs to where there are several.
ReportTable health_table(std::span<const Identification> traces);

/// Name, size and reading of the trace, conditions and health: how the text of identify, rig and twin begins.
void add_record(const Identification& record, TerminalText& text);

}  // namespace tribofit
