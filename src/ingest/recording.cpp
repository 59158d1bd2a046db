#include "recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "clock.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

void note_text_rows(const Rows& rows, FileRecord& recording) {
  if (rows.text_rows == 0) return;
  std::string note = fmt::format("{} line{} of text or comment dropped, the first is line {}", rows.text_rows,
                                 rows.text_rows == 1 ? "" : "s", rows.first_text_line);
  (rows.text_rows * 100 > rows.size() ? recording.warnings : recording.notes).push_back(std::move(note));
}

void add_all(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

std::string file_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

}  // namespace

FileRecord read_recording(const std::string& path, const ReadOptions& options) {
  const InputFile file(path);
  const Dialect dialect = find_dialect(file);
  FileRecord recording;
  recording.path = path;
  recording.column_names = dialect.names;
  recording.columns = find_columns(dialect, options, path);
  recording.notes = dialect.notes;
  add_all(recording.notes, recording.columns.notes);
  add_all(recording.warnings, recording.columns.warnings);
  if (recording.columns.used.empty()) refuse_columns(recording, "no recognisable columns");
  if (recording.columns.find(Channel::time) == nullptr && !options.rate) {
    refuse_columns(recording, "no time column");
  }

  Rows rows = read_rows(file, dialect, recording.columns.used, options.threads);
  if (rows.size() == 0) throw InputError("has no rows of numbers", "check that the export was complete", {path, 0, ""});
  note_text_rows(rows, recording);
  recording.checksum = rows.checksum;
  recording.lines = std::move(rows.lines);
  for (std::size_t k = 0; k < rows.values.size(); ++k) {
    recording[recording.columns.used[k].channel] = std::move(rows.values[k]);
  }
  set_clock(recording, options.rate);
  return recording;
}

void refuse_columns(const FileRecord& recording, const std::string& problem) {
  const bool no_header = !recording.column_names.empty() && recording.column_names.front() == "#1";
  std::string found;
  for (const std::string& name : recording.column_names) found += (found.empty() ? "" : ", ") + name;
  const std::string text =
      no_header ? problem + fmt::format("; the file has no header and {} columns", recording.column_names.size())
                : problem + " among: " + found;
  std::string advice = no_header ? "name the columns by number: --columns time=#1:s,mu=#2,v_b=#3:mm/s"
                                 : "name the columns: --columns time=NAME,mu=NAME,v_b=NAME";
  if (problem == "no time column") advice += ", or give the sampling rate: --rate 20kHz";
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
  const double gap = next.clock_start - run.clock_end;
  const double interval = typical_interval(run[Channel::time]);
  const bool goes_on = gap > 0;
  const double shift = run[Channel::time].back() + (goes_on ? gap : interval);
  run.notes.push_back(goes_on ? fmt::format("{} continues the run after {:.6g} s", file_name(next.path), gap)
                              : fmt::format("{} continues the run; its clock restarts and was joined without a pause",
                                            file_name(next.path)));
  for (double& t : next[Channel::time]) t += shift;
  for (std::size_t k = 0; k < channel_count; ++k) {
    if (run.channels[k].empty()) continue;
    run.channels[k].insert(run.channels[k].end(), next.channels[k].begin(), next.channels[k].end());
  }
  for (std::size_t i = 0; i < next.steps.size(); ++i) {
    Step step = next.steps[i];
    step.begin += before;
    step.end += before;
    if (step.label.empty()) step.label = file_name(next.path);
    run.steps.push_back(step);
    run.recipe_steps.push_back(recipe + next.recipe_steps[i]);
  }
  run.clock_end = goes_on ? next.clock_end : run.clock_end;
  run.checksum = hash_bytes(reinterpret_cast<const char*>(&next.checksum), sizeof next.checksum, run.checksum);
  run.parts.push_back({before, next.path, std::move(next.lines)});
  for (const std::string& note : next.notes) run.notes.push_back(fmt::format("file {}: {}", number, note));
  for (const std::string& warning : next.warnings) run.warnings.push_back(fmt::format("file {}: {}", number, warning));
}

InputLocation FileRecord::location(std::size_t row, Channel channel) const {
  const Column* column = columns.find(channel);
  const std::string name = column != nullptr ? column->name : std::string();
  const bool is_second = std::find(second_channels.begin(), second_channels.end(), channel) != second_channels.end();
  if (is_second) return {second_path, 0, name};
  row += cut_rows;
  for (std::size_t i = parts.size(); i-- > 0;) {
    if (row >= parts[i].begin) return {parts[i].path, parts[i].lines.line_of(row - parts[i].begin), name};
  }
  return {path, lines.line_of(row), name};
}

}  // namespace tribofit
