#include "recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "clock.hpp"
#include "column_names.hpp"
#include "content_hash.hpp"
#include "gaps.hpp"
#include "join.hpp"
#include "limits.hpp"
#include "load_point_columns.hpp"
#include "memory.hpp"
#include "points.hpp"
#include "stated_conditions.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

void add_all(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

std::string file_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

/// Notes and warnings of the table so far; each is taken once.
void take_messages(RawTable& table, FileRecord& recording) {
  add_all(recording.notes, std::exchange(table.notes, {}));
  add_all(recording.warnings, std::exchange(table.warnings, {}));
}

/// The sets of rows that hold a channel.
std::vector<std::size_t> rows_used(const RawTable& table, const std::vector<Column>& used) {
  std::vector<std::size_t> sets;
  for (const Column& column : used) {
    const std::size_t rows = table.columns[column.index].rows;
    if (std::find(sets.begin(), sets.end(), rows) == sets.end()) sets.push_back(rows);
  }
  return sets;
}

/// Of a set of rows: its columns, and how their time is known.
struct RowsPlan {
  std::size_t rows = 0;
  Columns columns;
  std::optional<Sampling> sampling;
  bool may_be_points = false;  ///< as far as the columns show it, and nobody said what the record is
};

/// Throws InputError where the file has times, but for other rows than this column's.
void refuse_without_time(const RawTable& table, const Column& column) {
  const std::size_t count = table.columns[column.index].count;
  const auto is_time = [](const RawColumn& c) {
    return name_rank(parse_column_name(c.name).base, Channel::time, std::nullopt) != no_rank;
  };
  if (count == 0 || std::none_of(table.columns.begin(), table.columns.end(), is_time)) return;
  throw InputError(fmt::format("holds {} values, and no time of as many", count),
                   "choose columns of one length with --columns; " + lists_columns(table.path),
                   table.heading(column.index));
}

/// Throws InputError where nothing says when the rows were recorded, and they are no points.
std::vector<RowsPlan> plan_rows(const RawTable& table, const FileRecord& file, const ReadOptions& options) {
  std::vector<RowsPlan> plans;
  for (const std::size_t rows : rows_used(table, file.columns.used)) {
    const bool points = options.kind == RecordKind::points;
    RowsPlan plan{rows, {}, points ? std::nullopt : stated_sampling(table, rows, options.rate), false};
    for (const Column& column : file.columns.used) {
      if (table.columns[column.index].rows == rows) plan.columns.used.push_back(column);
    }
    const bool alone = plan.columns.used.size() == file.columns.used.size();
    plan.may_be_points =
        !options.kind && options.second_file.empty() && !plan.sampling && alone && are_columns_of_points(plan.columns);
    if (plan.columns.find(Channel::time) == nullptr && !plan.sampling && !points && !plan.may_be_points) {
      refuse_without_time(table, plan.columns.used.front());
      refuse_columns(file, "no time column");
    }
    plans.push_back(std::move(plan));
  }
  return plans;
}

void load_columns(RawTable& table, const std::vector<Column>& used, int threads) {
  std::vector<std::size_t> wanted;
  std::size_t values = 0;
  for (const Column& column : used) {
    wanted.push_back(column.index);
    values += table.columns[column.index].count;
  }
  refuse_beyond_memory(static_cast<double>(values), 1, table.path);
  if (table.load) table.load(table, wanted, threads);
  for (const std::size_t index : wanted) {
    if (table.columns[index].refusal) throw *table.columns[index].refusal;
  }
}

/// Of the values of each channel in SI: a record is the same in whatever format it was written.
std::uint64_t checksum_of(const FileRecord& run, int threads) {
  std::vector<std::uint64_t> of_channels(channel_count, 0);
  run_tasks(of_channels.size(), threads, [&](std::size_t k) {
    const auto channel = static_cast<Channel>(k);
    const std::vector<double>& values = run[channel];
    if (run.has(channel))
      of_channels[k] = xxh64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)}, k);
  });
  return xxh64({reinterpret_cast<const char*>(of_channels.data()), of_channels.size() * sizeof(std::uint64_t)}, 0);
}

void refuse_unusable(const RawTable& table, const Column& column, std::size_t rows) {
  const RawColumn& raw = table.columns[column.index];
  if (raw.numbers.empty() && !raw.texts.empty()) {
    throw InputError("holds text, not numbers", "name another column with --columns", table.heading(column.index));
  }
  if (raw.numbers.size() != rows) {
    throw InputError(fmt::format("holds {} values where the columns beside it hold {}", raw.numbers.size(), rows),
                     "export the trace again, or leave the column out with --columns", table.heading(column.index));
  }
}

void to_si(const Column& column, std::vector<double>& values, int threads) {
  if (column.factor == 1 && column.offset == 0) return;
  run_over_parts(values.size(), threads, [&](std::size_t begin, std::size_t end) {
    const double factor = column.factor, offset = column.offset;  // which the values cannot alias
    for (std::size_t i = begin; i < end; ++i) values[i] = factor * values[i] + offset;
  });
}

/// Whether rows, in SI, are points: by statement, or because they have no times, or none that a clock made.
void recognise_points(const RowsPlan& plan, FileRecord& recording) {
  const std::vector<double>& time = recording[Channel::time];
  if (!plan.may_be_points || !(time.empty() || (time.size() <= kMostTabulated && is_no_clock(time)))) return;
  const std::size_t rows = recording[plan.columns.used.front().channel].size();
  if (time.empty() && rows > kMostTabulated) refuse_columns(recording, "no time column");
  recording.kind = RecordKind::points;
  recording.kind_source = time.empty() ? "no time column" : "the times are in no order";
}

/// Whether values go one way for nearly all of a record: a machine goes back to where it began at the end of a test.
bool go_one_way(const std::vector<double>& values) {
  constexpr std::size_t kLooks = 200;
  constexpr double kNearlyAll = 0.85, kStill = 1e-3;
  const std::size_t stride = 1 + values.size() / kLooks;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  std::size_t on = 0, back = 0;
  for (std::size_t i = stride; i < values.size(); i += stride) {
    const double way = values[i] - values[i - stride];
    on += way > kStill * (*high - *low) ? 1U : 0U;
    back += way < -kStill * (*high - *low) ? 1U : 0U;
  }
  return static_cast<double>(std::max(on, back)) > kNearlyAll * static_cast<double>(on + back);
}

/// Whether a speed stays what it is but for steps, and never turns, as one that is set does.
bool keeps_to_steps(const std::vector<double>& values) {
  constexpr double kStays = 0.02, kLeastStep = 1.5;
  double low = std::numeric_limits<double>::infinity(), high = 0;
  std::size_t stays = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] >= 0)) return false;
    low = std::min(low, values[i]);
    high = std::max(high, values[i]);
    stays += i > 0 && std::abs(values[i] - values[i - 1]) <= kStays * values[i - 1] ? 1U : 0U;
  }
  return high > kLeastStep * low && stays >= values.size() - values.size() / 20;
}

/// A velocity of which nothing more is known is that of a load point where it keeps to steps.
bool take_speed_of_load_point(FileRecord& recording) {
  for (Column& column : recording.columns.used) {
    if (!column.plain || (column.channel != Channel::v_b && column.channel != Channel::v_r)) continue;
    if (!keeps_to_steps(recording[column.channel])) return false;
    recording[Channel::v_lp] = std::exchange(recording[column.channel], {});
    column.channel = Channel::v_lp;
    return true;
  }
  return false;
}

/// Friction beside a load point, and no motion of the contact, is a record of velocity steps. A displacement of which
/// nothing more is known is that of a load point where it goes one way; else it says nothing.
void recognise_steps(FileRecord& recording) {
  if (recording.kind || !recording.has_friction()) return;
  Columns& columns = recording.columns;
  const Column* displacement = columns.find(Channel::x_d);
  const bool is_named =
      recording.has(Channel::v_lp) || (displacement != nullptr && names_load_point(displacement->plain_name));
  const bool is_of_contact =
      recording.has(Channel::x_b) || std::any_of(columns.used.begin(), columns.used.end(), [](const Column& c) {
        return (c.channel == Channel::v_b || c.channel == Channel::v_r) && !is_plain_velocity(c.plain_name);
      });
  const Column* force = columns.find(Channel::force);
  const bool is_coefficient = recording.has(Channel::mu) || (force != nullptr && force->stress);
  bool is_plain = displacement != nullptr && displacement->plain;
  if (is_plain && !(is_coefficient && go_one_way(recording[Channel::x_d]))) {
    is_plain = false;
    if (!displacement->requested) {
      recording.unused_displacement = recording.column_names[displacement->index];
      recording[Channel::x_d].clear();
      std::erase_if(columns.used, [](const Column& c) { return c.channel == Channel::x_d; });
    }
  }
  if (is_of_contact || !(is_named || is_coefficient)) return;
  if (is_named) {
    recording.kind_source = "the motion of a load point was recorded";
  } else if (is_plain) {
    recording.kind_source = "a displacement in one direction is all the motion recorded";
  } else if (take_speed_of_load_point(recording)) {
    recording.kind_source = "a speed that is set in steps is all the motion recorded";
  } else {
    return;
  }
  recording.kind = RecordKind::velocity_steps;
}

/// The channels of one set of rows, in SI, on a clock that starts at 0; points are numbered instead.
FileRecord take_rows(RawTable& table, RowsPlan plan, const FileRecord& file, int threads) {
  FileRecord recording;
  recording.path = file.path;
  recording.column_names = file.column_names;
  recording.has_names = file.has_names;
  recording.file_conditions = file.file_conditions;
  recording.kind = file.kind;
  recording.kind_source = file.kind_source;
  recording.columns = plan.columns;
  recording.lines = std::move(table.rows[plan.rows].lines);
  recording.stated_steps = std::move(table.rows[plan.rows].steps);
  const std::vector<Column>& used = recording.columns.used;
  const std::size_t rows = table.columns[used.front().index].numbers.size();
  for (const Column& column : used) refuse_unusable(table, column, rows);
  const auto gappy = table.is_finite ? std::vector<std::size_t>() : find_gappy_rows(table, used, recording);
  for (std::size_t k = 0; k < used.size(); ++k) {
    auto& values = table.columns[used[k].index].numbers;
    const bool again = std::any_of(used.begin() + static_cast<std::ptrdiff_t>(k) + 1, used.end(),
                                   [&](const Column& c) { return c.index == used[k].index; });
    recording[used[k].channel] = again ? values : std::move(values);
    to_si(used[k], recording[used[k].channel], threads);
  }
  if (rows == 0) throw InputError("holds no values", "check that the export was complete", {file.path, 0, ""});
  recognise_points(plan, recording);
  recognise_steps(recording);
  if (!recording.has(Channel::time) && !recording.is_points()) set_time(recording, *plan.sampling);
  exclude(gappy, "with a cell that is not a number", recording);
  if (recording.is_driven()) exclude(find_repeated_rows(recording), "at the time of the row before", recording);
  if (recording.is_points()) {
    set_points(recording);
    return recording;
  }
  set_clock(recording, plan.sampling, threads);
  return recording;
}

}  // namespace

FileRecord read_recording(const std::string& path, const ReadOptions& options, std::span<const Reader> readers) {
  FileRecord run = read_recording(read_table(path, readers), path, options);
  run.checksum = checksum_of(run, options.threads);
  return run;
}

FileRecord read_recording(RawTable table, const std::string& path, const ReadOptions& options) {
  FileRecord file;
  file.path = path;
  file.column_names = table.names();
  file.has_names = table.has_names();
  file.kind = options.kind;
  if (options.kind) file.kind_source = "stated";
  take_messages(table, file);
  const StatedConditions stated = stated_conditions(table.facts, table);
  file.file_conditions = stated.conditions;
  add_all(file.notes, stated.notes);
  file.columns = find_columns(table, options);
  add_all(file.notes, file.columns.notes);
  add_all(file.warnings, file.columns.warnings);
  if (file.columns.used.empty()) refuse_columns(file, "no recognisable columns");
  std::vector<RowsPlan> plans = plan_rows(table, file, options);

  load_columns(table, file.columns.used, options.threads);
  take_messages(table, file);
  std::vector<FileRecord> parts;
  for (RowsPlan& plan : plans) parts.push_back(take_rows(table, std::move(plan), file, options.threads));
  const auto with_friction =
      std::find_if(parts.begin(), parts.end(), [](const FileRecord& part) { return part.has_friction(); });
  if (with_friction != parts.end()) std::iter_swap(parts.begin(), with_friction);
  FileRecord run = std::move(parts.front());
  run.notes.insert(run.notes.begin(), file.notes.begin(), file.notes.end());
  run.warnings.insert(run.warnings.begin(), file.warnings.begin(), file.warnings.end());
  for (std::size_t i = 1; i < parts.size(); ++i) join_on_one_clock(run, std::move(parts[i]));
  return run;
}

void refuse_columns(const FileRecord& recording, const std::string& problem) {
  const bool names = recording.has_names;
  const std::string text =
      names ? problem + " among: " + listed(recording.column_names)
            : problem + fmt::format("; the file has no header and {} columns", recording.column_names.size());
  std::string advice = names ? "name the columns: --columns time=NAME,mu=NAME,v_b=NAME"
                             : "name the columns by number: --columns time=#1:s,mu=#2,v_b=#3:mm/s";
  if (problem == "no time column")
    advice += ", or give the sampling rate: --rate 20kHz; a table of steady points without time is --kind points";
  if (problem.starts_with("no velocity") && !recording.unused_displacement.empty())
    advice += fmt::format("; where {} is the displacement of a drive that keeps to speeds, give --kind velocity-steps",
                          recording.unused_displacement);
  advice += "; " + lists_columns(recording.path);
  throw InputError(text, advice, {recording.path, 0, ""});
}

void continue_recording(FileRecord& run, FileRecord next, std::size_t number) {
  for (std::size_t k = 0; k < channel_count; ++k) {
    const auto channel = static_cast<Channel>(k);
    if (channel == Channel::step || run.has(channel) == next.has(channel)) continue;
    throw InputError(fmt::format("has {} column for {}, unlike {}", next.has(channel) ? "a" : "no", to_string(channel),
                                 file_name(run.path)),
                     "files of one run must have the same columns", {next.path, 0, ""});
  }
  if (run.steps.size() == 1 && run.steps.front().label.empty()) run.steps.front().label = file_name(run.path);
  const std::size_t before = run.size(), recipe = run.recipe_size();
  if (run.is_points() != next.is_points()) {
    throw InputError("is a table of points, unlike the other file of the run, or the other way round", "state --kind",
                     {next.path, 0, ""});
  }
  const double gap = next.clock_start - run.clock_end;
  const double interval = typical_interval(run[Channel::time]);
  const bool goes_on = gap > 0 && !run.is_points();
  const double shift = run[Channel::time].back() + (goes_on ? gap : interval);
  const std::string continued = file_name(next.path);
  run.notes.push_back(run.is_points() ? continued + " adds points"
                      : goes_on ? fmt::format("{} continues the run after {} s", file_name(next.path), general(gap, 6))
                                : fmt::format("{} continues the run; its clock restarts and was joined without a pause",
                                              file_name(next.path)));
  for (double& t : next[Channel::time]) t += shift;
  for (const Channel channel : run.present())
    run[channel].insert(run[channel].end(), next[channel].begin(), next[channel].end());
  for (std::size_t i = 0; i < next.steps.size(); ++i) {
    Step step = next.steps[i];
    step.begin += before;
    step.end += before;
    if (step.label.empty()) step.label = file_name(next.path);
    run.steps.push_back(step);
    run.recipe_steps.push_back(recipe + next.recipe_steps[i]);
  }
  run.clock_end = goes_on ? next.clock_end : run.clock_end;
  run.checksum = xxh64(next.checksum, run.checksum);
  run.parts.push_back({before, next.path, std::move(next.lines)});
  for (const std::string& note : next.notes) run.notes.push_back(fmt::format("file {}: {}", number, note));
  for (const std::string& warning : next.warnings) run.warnings.push_back(fmt::format("file {}: {}", number, warning));
}

std::vector<Channel> FileRecord::present() const {
  std::vector<Channel> channels;
  for (std::size_t k = 0; k < channel_count; ++k) {
    if (has(static_cast<Channel>(k))) channels.push_back(static_cast<Channel>(k));
  }
  return channels;
}

InputLocation FileRecord::location(std::size_t row, Channel channel) const {
  const Column* column = columns.find(channel);
  const std::string name = column != nullptr ? column->name : std::string();
  const bool is_second = std::find(second_channels.begin(), second_channels.end(), channel) != second_channels.end();
  if (is_second) return {second_path, 0, name};
  row += cut_rows;
  const auto in = [&](const std::string& file, const LineMap& map, std::size_t at) -> InputLocation {
    const std::size_t line = map.line_of(at);
    return {file, line, name, line > 0 ? 0 : at + 1};
  };
  for (std::size_t i = parts.size(); i-- > 0;) {
    if (row >= parts[i].begin) return in(parts[i].path, parts[i].lines, row - parts[i].begin);
  }
  return in(path, lines, row);
}

std::string FileRecord::place_of(std::size_t row) const {
  const InputLocation where = location(row, Channel::time);
  return where.line > 0 ? fmt::format("line {}", where.line) : fmt::format("value {}", where.value);
}

}  // namespace tribofit
