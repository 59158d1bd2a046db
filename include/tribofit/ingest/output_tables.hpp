#pragma once

#include <array>
#include <string>
#include <string_view>

namespace tribofit {

/// A table that `--csv FOLDER` writes: its name, and the beginning of its header, by which it is known again.
struct OutputTable {
  std::string_view name, header;
};
inline constexpr std::array<OutputTable, 6> output_tables = {
    {{"samples.csv", "time_s,relative_velocity_mm_s,mu,mu_model"},
     {"cycles.csv", "cycle,direction,break_away_time_s"},
     {"curves.csv", "law,effects,protocol,relative_velocity_mm_s"},
     {"errors.csv", "time_s,relative_velocity_mm_s,residual_"},
     {"response.csv", "step_number,time_s,load_point_um,mu,mu_model"},
     {"steps.csv", "step_number,time_s,from_um_s,to_um_s,hold_s"}}};

/// Whether the file is one of those tables, by its name and its header: a result, not a run. A file that cannot be read
/// is not.
bool is_output_table(const std::string& path);

}  // namespace tribofit
