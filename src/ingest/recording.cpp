#include "recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "content_hash.hpp"
#include "limits.hpp"
#include "stated_conditions.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

using Texts = std::vector<std::string>;

void add_all(Texts& to, const Texts& from, const std::string& before = {}) {
  for (const std::string& text : from) to.push_back(before + text);
}

std::string file_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

/// A set of rows: its columns, and how their time is known.
struct RowsPlan {
  std::size_t rows = 0;
  Columns columns;
  std::optional<Sampling> sampling;
  bool may_be_points = false;  ///< as far as the columns show it, and nobody said what the record is
};

/// Throws InputError where the file has times, but for other rows than this column's.
void refuse_without_time(const RawTable& table, const Column& column) {
  const std::size_t count = table.columns[column.index].count;
  const auto is_time = [](const RawColumn& c) { return name_rank(label_of(c).base, Channel::time) != no_rank; };
  if (count == 0 || std::ranges::none_of(table.columns, is_time)) return;
  throw InputError(fmt::format("holds {} values, and no time of as many", count),
                   "choose columns of one length with " + setting("columns") + "; " + lists_columns(table.path),
                   table.heading(column.index));
}

/// The sets of rows that hold a channel. Throws InputError where nothing says when the rows were recorded, and they are
/// no points.
std::vector<RowsPlan> plan_rows(const RawTable& table, const FileRecord& file, const ReadOptions& options) {
  std::vector<RowsPlan> plans;
  for (const Column& column : file.columns.used) {
    const std::size_t rows = table.columns[column.index].rows;
    auto plan = std::ranges::find(plans, rows, &RowsPlan::rows);
    if (plan == plans.end()) plan = plans.insert(plan, {rows, {}, std::nullopt, false});
    plan->columns.used.push_back(column);
  }
  const bool points = options.kind == RecordKind::points;
  for (RowsPlan& plan : plans) {
    if (!points) plan.sampling = stated_sampling(table, plan.rows, options.rate);
    plan.may_be_points = !options.kind && options.second_file.empty() && !plan.sampling && plans.size() == 1 &&
                         are_columns_of_points(plan.columns);
    if (plan.columns.find(Channel::time) != nullptr || plan.sampling || points || plan.may_be_points) continue;
    refuse_without_time(table, plan.columns.used.front());
    refuse_columns(file, "no time column");
  }
  return plans;
}

void load_columns(RawTable& table, const std::vector<Column>& used, int threads) {
  std::set<std::size_t> indices;
  for (const Column& column : used) indices.insert(column.index);
  const std::vector<std::size_t> wanted(indices.begin(), indices.end());
  std::size_t values = 0;
  for (const std::size_t index : wanted) values += table.columns[index].count;
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
    const std::vector<double>& values = run[all_channels[k]];
    if (run.has(all_channels[k]))
      of_channels[k] = xxh64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)}, k);
  });
  return xxh64({reinterpret_cast<const char*>(of_channels.data()), of_channels.size() * sizeof(std::uint64_t)}, 0);
}

void refuse_unusable(const RawTable& table, const Column& column, std::size_t rows) {
  const RawColumn& raw = table.columns[column.index];
  if (raw.numbers.empty() && raw.is_text) {
    throw InputError("holds text, not numbers", "name another column with " + setting("columns"),
                     table.heading(column.index));
  }
  if (raw.numbers.size() != rows) {
    throw InputError(fmt::format("holds {} values where the columns beside it hold {}", raw.numbers.size(), rows),
                     "export the trace again, or leave the column out with " + setting("columns"),
                     table.heading(column.index));
  }
}

void to_si(const Column& column, std::vector<double>& values) {
  if (column.factor == 1 && column.offset == 0) return;
  for (double& value : values) value = column.factor * value + column.offset;
}

/// Fills the recording with the channels of one set of rows, in SI, on a clock that starts at 0; points are numbered
/// instead.
void take_rows(RawTable& table, const RowsPlan& plan, FileRecord& recording) {
  recording.columns = plan.columns;
  recording.lines = std::move(table.rows[plan.rows].lines);
  recording.stated_steps = std::move(table.rows[plan.rows].steps);
  const std::vector<Column>& used = plan.columns.used;
  const std::size_t rows = table.columns[used.front().index].numbers.size();
  for (const Column& column : used) refuse_unusable(table, column, rows);
  const auto gappy = find_gappy_rows(table, used, recording);
  for (auto column = used.begin(); column != used.end(); ++column) {
    auto& values = table.columns[column->index].numbers;
    const bool again =
        std::find_if(column + 1, used.end(), [&](const Column& c) { return c.index == column->index; }) != used.end();
    recording[column->channel] = again ? values : std::move(values);
    to_si(*column, recording[column->channel]);
  }
  if (rows == 0) throw InputError("holds no values", "check that the export was complete", recording.file());
  recognise_points(plan.may_be_points, recording);
  recognise_steps(recording);
  if (!recording.has(Channel::time) && !recording.is_points()) set_time(recording, *plan.sampling);
  exclude(gappy, "with a cell that is not a number", recording);
  if (recording.is_driven()) exclude(find_repeated_rows(recording), "at the time of the row before", recording);
  if (recording.is_points()) return set_points(recording);
  set_clock(recording, plan.sampling);
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
  Texts notes = std::exchange(table.notes, {}), warnings = std::exchange(table.warnings, {});
  const StatedConditions stated = conditions_in(table.facts, table);
  file.file_conditions = stated.conditions;
  file.columns = find_columns(table, options);
  add_all(notes, stated.notes);
  add_all(notes, file.columns.notes);
  add_all(warnings, file.columns.warnings);
  if (file.columns.used.empty()) refuse_columns(file, "no recognisable columns");
  const std::vector<RowsPlan> plans = plan_rows(table, file, options);

  load_columns(table, file.columns.used, options.threads);
  add_all(notes, table.notes);
  add_all(warnings, table.warnings);
  std::vector<FileRecord> parts(plans.size(), file);
  for (std::size_t k = 0; k < plans.size(); ++k) take_rows(table, plans[k], parts[k]);
  const auto with_friction = std::ranges::find_if(parts, &FileRecord::has_friction);
  if (with_friction != parts.end()) std::iter_swap(parts.begin(), with_friction);
  FileRecord run = std::move(parts.front());
  run.notes.insert(run.notes.begin(), notes.begin(), notes.end());
  run.warnings.insert(run.warnings.begin(), warnings.begin(), warnings.end());
  for (std::size_t i = 1; i < parts.size(); ++i) join_on_one_clock(run, std::move(parts[i]));
  return run;
}

void refuse_columns(const FileRecord& recording, const std::string& problem) {
  const bool names = recording.has_names;
  const std::string text =
      names ? problem + " among: " + listed(recording.column_names)
            : problem + fmt::format("; the file has no header and {} columns", recording.column_names.size());
  std::string advice = names ? "name the columns: " + setting("columns", "time=NAME,mu=NAME,v_b=NAME")
                             : "name the columns by number: " + setting("columns", "time=#1:s,mu=#2,v_b=#3:mm/s");
  if (problem == "no time column")
    advice += ", or give the sampling rate: " + setting("rate", "20kHz") +
              "; a table of steady points without time is " + setting("kind", "points");
  if (problem.starts_with("no velocity") && !recording.unused_displacement.empty())
    advice += fmt::format("; where {} is the displacement of a drive that keeps to speeds, give {}",
                          recording.unused_displacement, setting("kind", "velocity-steps"));
  throw InputError(text, advice + "; " + lists_columns(recording.path), recording.file());
}

void continue_recording(FileRecord& run, FileRecord next, std::size_t number) {
  for (const Channel channel : all_channels) {
    if (channel == Channel::step || run.has(channel) == next.has(channel)) continue;
    throw InputError(fmt::format("has {} column for {}, unlike {}", next.has(channel) ? "a" : "no", to_string(channel),
                                 file_name(run.path)),
                     "files of one run must have the same columns", next.file());
  }
  if (run.steps.size() == 1 && run.steps.front().label.empty()) run.steps.front().label = file_name(run.path);
  const std::size_t before = run.size(), recipe = run.recipe_size();
  if (run.is_points() != next.is_points()) {
    throw InputError("is a table of points, unlike the other file of the run, or the other way round",
                     "state " + setting("kind"), next.file());
  }
  const double gap = next.clock_start - run.clock_end;
  const bool goes_on = gap > 0 && !run.is_points();
  const double shift = run.time.back() + (goes_on ? gap : typical_interval(run.time));
  const std::string continued = file_name(next.path);
  run.notes.push_back(continued + (run.is_points() ? std::string(" adds points")
                                   : goes_on
                                       ? fmt::format(" continues the run after {} s", general(gap, 6))
                                       : " continues the run; its clock restarts and was joined without a pause"));
  for (double& t : next.time) t += shift;
  for (const Channel channel : run.present())
    run[channel].insert(run[channel].end(), next[channel].begin(), next[channel].end());
  for (Step step : next.steps) {
    step.begin += before;
    step.end += before;
    step.recipe += recipe;
    if (step.label.empty()) step.label = continued;
    run.steps.push_back(step);
  }
  run.clock_end = goes_on ? next.clock_end : run.clock_end;
  run.checksum = xxh64(next.checksum, run.checksum);
  run.parts.push_back({before, next.path, std::move(next.lines)});
  add_all(run.notes, next.notes, fmt::format("file {}: ", number));
  add_all(run.warnings, next.warnings, fmt::format("file {}: ", number));
}

std::vector<Channel> FileRecord::present() const {
  std::vector<Channel> channels;
  std::ranges::copy_if(all_channels, std::back_inserter(channels), [&](Channel channel) { return has(channel); });
  return channels;
}

std::size_t FileRecord::rows() const {
  std::size_t rows = 0;
  for (const Channel channel : present()) rows = std::max(rows, (*this)[channel].size());
  return rows;
}

void FileRecord::keep_rows(std::size_t begin, std::size_t end) {
  for (const Channel which : present()) {
    std::vector<double>& channel = (*this)[which];
    channel.resize(end);
    channel.erase(channel.begin(), channel.begin() + static_cast<std::ptrdiff_t>(begin));
  }
  for (Step& step : steps) {
    step.begin = std::clamp(step.begin, begin, end) - begin;
    step.end = std::clamp(step.end, begin, end) - begin;
  }
  std::erase_if(steps, [](const Step& step) { return step.begin == step.end; });
  cut_rows += begin;
}

InputLocation FileRecord::location(std::size_t row, Channel channel) const {
  const Column* column = columns.find(channel);
  const std::string name = column != nullptr ? column->name : std::string();
  if (std::ranges::find(second_channels, channel) != second_channels.end()) return {second_path, 0, name};
  row += cut_rows;
  const auto in = [&](const std::string& from, const LineMap& map, std::size_t at) -> InputLocation {
    const std::size_t line = map.line_of(at);
    return {from, line, name, line > 0 ? 0 : at + 1};
  };
  for (std::size_t i = parts.size(); i-- > 0;) {
    if (row >= parts[i].begin) return in(parts[i].path, parts[i].lines, row - parts[i].begin);
  }
  return in(path, lines, row);
}

std::string FileRecord::places_of(const std::vector<std::size_t>& rows) const {
  constexpr std::size_t most_shown = 12;
  Texts places;
  bool has_lines = false;
  for (const std::size_t row : rows) {
    const InputLocation where = location(row, Channel::time);
    has_lines = where.line > 0;
    places.push_back(std::to_string(has_lines ? where.line : where.value));
    if (places.size() > most_shown) break;
  }
  if (places.size() > most_shown) places.back() = "...";
  return fmt::format("{}{} {}", has_lines ? "line" : "value", rows.size() == 1 ? "" : "s", listed(places));
}

}  // namespace tribofit
