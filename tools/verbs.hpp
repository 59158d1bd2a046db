#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "console.hpp"
#include "inputs.hpp"
#include "results.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/report/terminal.hpp"

/// Shows what was found of one trace; failure: why that is not what was asked for, or empty.
template <class Result>
ExitStatus show_alone(const Settings& settings, const Input& input, Result& result,
                      const std::vector<std::string>& arguments, const std::string& failure) {
  add_remarks(input, result.trace);
  deliver(settings, {[&] { return report_of(result, terminal_options(settings, arguments_for(input, arguments))); },
                     [&] { return to_json(result, {arguments}); }});
  if (failure.empty()) return ExitStatus::done;
  print_error(result.trace.path + ": " + failure);
  return ExitStatus::failed;
}

/// Each verb adds its options and what it runs. It may throw UsageError and tribofit::InputError, which main() prints.
void add_identify(const Command& app);
void add_columns(const Command& app);
void add_manifest(const Command& app);
void add_merge(const Command& app);
void add_diagnose(const Command& app);
void add_plan(const Command& app);
void add_explore(const Command& app);
void add_rig(const Command& app);
void add_twin(const Command& app);
void add_effects(const Command& app);
void add_cite(const Command& app);
void add_simulate(const Command& app);
void add_study(const Command& app);
void add_help(const Command& app);
void add_completion(const Command& app);
