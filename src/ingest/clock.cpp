#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "limits.hpp"
#include "recording.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {
namespace {

class Clock {
 public:
  explicit Clock(FileRecord& recording)
      : recording_(recording),
        time_(recording[Channel::time]),
        step_(recording[Channel::step]),
        interval_(typical_interval(time_)),
        any_rate_(recording.is_driven()) {
    ignore_counter();
  }

  void run() {
    recording_.clock_start = time_.front();
    recording_.clock_end = time_.back();
    begin_step(0, true);
    double shift = -time_.front(), last = time_.front();
    double step_start = last;
    time_.front() = 0;
    for (std::size_t i = 1; i < time_.size(); ++i) {
      const double now = time_[i], interval = now - last;
      const bool step_changes = begins_step(i);
      if (interval > 0 && (interval <= kGapInterval * interval_ || any_rate_) && !step_changes) [[likely]] {
        time_[i] = now + shift;
      } else {
        if (!(interval > 0)) {
          if (!step_changes && !restarts_at(i, step_start, last)) refuse(i, last);
          shift = time_[i - 1] + interval_ - now;
          restarts_.push_back(i);
        } else if (!step_changes) {
          gaps_.push_back(i);
        }
        const bool is_gap = interval > 0 && !step_changes;
        if (!is_gap) step_start = now;
        begin_step(i, !is_gap);
        time_[i] = now + shift;
      }
      if (!(time_[i] > time_[i - 1])) refuse_rounding(i);
      last = now;
    }
    recording_.steps.back().end = time_.size();
    refuse_irregular();
    warn_of_gaps();
    note_restarts();
  }

 private:
  /// Whether the file says that a step begins here.
  bool begins_step(std::size_t row) {
    const auto& stated = recording_.stated_steps;
    if (stated.empty()) return !step_.empty() && step_[row] != step_[row - 1];
    if (stated_ + 1 >= stated.size() || stated[stated_ + 1].begin != row) return false;
    ++stated_;
    return true;
  }

  bool restarts_at(std::size_t row, double step_start, double last) const {
    const bool back_to_start = time_[row] <= step_start + kGapInterval * interval_;
    return back_to_start && row - recording_.steps.back().begin >= kShortestStep && goes_on_from(row, last);
  }

  /// A lone time stamp that is wrong is followed by the old clock; a restarted clock counts on from its start.
  bool goes_on_from(std::size_t row, double old_clock) const {
    if (row + kGoesOnFor > time_.size()) return false;
    for (std::size_t i = row + 1; i < row + kGoesOnFor; ++i) {
      if (!(time_[i] > time_[i - 1]) || time_[i] >= old_clock) return false;
    }
    return true;
  }

  /// A column called "step" that changes all the time counts samples, not steps of a recipe.
  void ignore_counter() {
    std::size_t changes = 0;
    for (std::size_t i = 1; i < step_.size(); ++i) changes += step_[i] != step_[i - 1] ? 1U : 0U;
    if (changes <= kMostStepChanges || changes * kRowsPerStepChange <= step_.size()) return;
    recording_.warnings.push_back(fmt::format("column {} changes {} times and was not taken for steps of a recipe",
                                              recording_.location(0, Channel::step).column, changes));
    step_.clear();
  }

  void begin_step(std::size_t row, bool in_recipe) {
    if (!recording_.steps.empty()) recording_.steps.back().end = row;
    Step step;
    step.begin = row;
    step.conditions = recording_.file_conditions;
    const auto& stated = recording_.stated_steps;
    if (!stated.empty()) {
      step.label = stated[stated_].label;
      step.conditions = first_known(stated[stated_].conditions, step.conditions);
    } else if (!in_recipe) {
      step.label = recording_.steps.back().label;
    } else if (!step_.empty()) {
      step.label = fmt::format("{}", general(step_[row]));
    }
    step.recipe = in_recipe ? recording_.recipe_size() : recording_.recipe_size() - 1;
    recording_.steps.push_back(step);
  }

  static std::string too_coarse() {
    return "where the clock is written too coarsely, give the sampling rate with " + setting("rate");
  }

  [[noreturn]] void refuse(std::size_t row, double last) const {
    const bool repeats = time_[row] == last;
    throw InputError(
        fmt::format("time {} ({} s after {} s)", repeats ? "repeats" : "goes backwards", general(time_[row], 9),
                    general(last, 9)),
        repeats ? "remove the row; " + too_coarse()
                : "sort or split the file; steps whose clock restarts need their own start time or a step column",
        recording_.location(row, Channel::time));
  }

  [[noreturn]] void refuse_rounding(std::size_t row) const {
    throw InputError("the interval is lost beside the time that has passed",
                     "give the sampling rate with " + setting("rate") + ", or start the clock at 0",
                     recording_.location(row, Channel::time));
  }

  void refuse_irregular() const {
    if (gaps_.size() <= kMostGaps || gaps_.size() * kRowsPerGap <= time_.size()) return;
    throw InputError(fmt::format("the clock is irregular: {} intervals are longer than {} times the median of {} s",
                                 gaps_.size(), general(kGapInterval), general(interval_, 6)),
                     "resample the trace; " + too_coarse(), recording_.location(gaps_.front(), Channel::time));
  }

  void warn_of_gaps() {
    if (gaps_.empty()) return;
    const std::size_t first = gaps_.front();
    recording_.warnings.push_back(
        fmt::format("{} gap{} in time, the first of {} s before {} (interval {} s); the data after a gap are a step of "
                    "their own",
                    gaps_.size(), gaps_.size() == 1 ? "" : "s", general(time_[first] - time_[first - 1], 6),
                    recording_.places_of({first}), general(interval_, 6)));
  }

  void note_restarts() {
    if (restarts_.empty()) return;
    recording_.notes.push_back(
        fmt::format("the clock restarts {} time{} ({}); the steps follow one another without a pause", restarts_.size(),
                    restarts_.size() == 1 ? "" : "s", recording_.places_of(restarts_)));
  }

  FileRecord& recording_;
  std::vector<double>& time_;
  std::vector<double>& step_;
  double interval_;
  bool any_rate_;           // the sampling may change: what is fitted knows the time of every sample
  std::size_t stated_ = 0;  // the stated step that a row belongs to
  std::vector<std::size_t> gaps_, restarts_;
};

/// A fact that states the sampling, as a rate or as an interval.
std::optional<Sampling> sampling_from(const RawFact& fact) {
  const std::string base = parse_column_name(fact.name).base;
  Sampling sampling;
  if (is_among(base,
               "fs rate samplerate samplingrate samplefrequency samplingfrequency abtastrate abtastfrequenz "
               "\u91c7\u6837\u9891\u7387 \u91c7\u6837\u7387")) {
    sampling.rate = value_of(fact, Quantity::frequency, "Hz").value_or(0);
  } else if (is_among(base,
                      "dt interval sampleinterval samplinginterval samplingtimeinterval sampleperiod samplingperiod "
                      "timestep timeinterval deltat deltax abtastintervall \u91c7\u6837\u95f4\u9694")) {
    sampling.interval = value_of(fact, Quantity::time, "s").value_or(0);
  }
  if (!sampling.is_possible()) return std::nullopt;
  const std::string place = fact.line > 0 ? fmt::format(" in line {}", fact.line) : "";
  sampling.source = fmt::format("'{}: {}'{} of the file", fact.name, fact.value, place);
  return sampling;
}

}  // namespace

bool Sampling::is_possible() const {
  const double size = rate + interval;
  return size > 0 && std::isfinite(size) && std::isfinite(start);
}

std::optional<Sampling> stated_sampling(const RawTable& table, std::size_t rows, std::optional<double> rate) {
  if (rate) return Sampling{0, *rate, 0, true, fmt::format("the sampling rate of {} Hz", general(*rate))};
  if (const auto interval = table.rows[rows].interval) {
    return Sampling{table.rows[rows].start, 0, *interval, false,
                    fmt::format("the interval of {} s in the file", general(*interval))};
  }
  for (const RawFact& fact : table.facts) {
    if (auto sampling = sampling_from(fact)) return sampling;
  }
  return std::nullopt;
}

void set_time(FileRecord& recording, const Sampling& sampling) {
  if (!sampling.is_possible()) {
    throw InputError(sampling.by_user ? "the sampling rate must be positive" : "the stated sampling is not possible",
                     "give the sampling rate as " + setting("rate", "20kHz"), recording.file());
  }
  auto& time = recording[Channel::time];
  time.resize(recording.rows());
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double row = static_cast<double>(i);
    time[i] = sampling.start + (sampling.rate > 0 ? row / sampling.rate : row * sampling.interval);
  }
  recording.notes.push_back("time from " + sampling.source);
}

void set_clock(FileRecord& recording, const std::optional<Sampling>& sampling) {
  if (sampling && sampling->by_user) {
    const double found = 1 / typical_interval(recording[Channel::time]);
    if (std::abs(found / sampling->rate - 1) > kSameRate) {
      recording.warnings.push_back(fmt::format("the stated rate of {} Hz was not used: the time column says {} Hz",
                                               general(sampling->rate), general(found)));
    }
  }
  Clock(recording).run();
  if (!(recording.size() > 1)) {
    throw InputError("has one row only", "a trace needs at least two samples", recording.file());
  }
}

double typical_interval(const std::vector<double>& time) {
  if (time.size() < 2) return 0;
  const std::size_t intervals = time.size() - 1, stride = std::max<std::size_t>(1, intervals / kIntervalsForMedian);
  std::vector<double> sample;
  for (std::size_t i = 0; i < intervals; i += stride) {
    if (time[i + 1] > time[i]) sample.push_back(time[i + 1] - time[i]);
  }
  return sample.empty() ? 0 : median(std::move(sample));
}

double Trace::interval() const {
  if (time.size() < 2) return 0;
  const double longest = kGapInterval * typical_interval(time);
  std::size_t count = 0;  // of gaps: most records have none, which is seen faster than added up
  for (std::size_t i = 1; i < time.size(); ++i) count += time[i] - time[i - 1] > longest ? 1U : 0U;
  double gaps = 0;
  for (std::size_t i = 1; count > 0 && i < time.size(); ++i) {
    if (const double d = time[i] - time[i - 1]; d > longest) gaps += d;
  }
  if (count + 1 >= time.size()) return duration() / static_cast<double>(time.size() - 1);
  return (duration() - gaps) / static_cast<double>(time.size() - 1 - count);
}

}  // namespace tribofit
