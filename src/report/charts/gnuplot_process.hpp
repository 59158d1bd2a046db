#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tribofit {

/// Whether there is a program called gnuplot to run.
bool gnuplot_is_installed();

/// Runs gnuplot once. write_script(outputs) returns what it reads, where outputs[k] is the name under which it writes
/// the k-th of `count` outputs. Returns what it wrote; there are no files of that name when this returns, whatever
/// happens. Throws InputError where gnuplot is missing, fails, or leaves an output empty.
std::vector<std::string> run_gnuplot(
    std::size_t count, const std::function<std::string(const std::vector<std::string>& outputs)>& write_script);

}  // namespace tribofit
