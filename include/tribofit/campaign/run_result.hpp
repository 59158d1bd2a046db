#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/campaign/figures.hpp"
#include "tribofit/ingest/conditions.hpp"
#include "tribofit/ingest/manifest.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

struct CondensedRun;

/// How the work on a run ended.
enum class RunStatus {
  ok,         ///< fitted
  failed,     ///< read, but the analysis could not be done; doing it again ends alike
  unreadable  ///< not read, or not to the end; tried again each time
};
/// "ok", "failed", "unreadable": as result files and summaries have them.
std::string_view to_string(RunStatus status);

/// What a result file says of its run besides the analysis, under the key "run".
struct RunRecord {
  std::string name, file;  ///< see Run
  std::string key;         ///< of all that the result depends on, see run_key(); 16 hexadecimal digits
  std::string settings;    ///< the part of it that is known without reading the trace
  RunStatus status = RunStatus::ok;
  std::string message;    ///< why it is not ok
  Conditions conditions;  ///< as stated beforehand
  std::optional<int> repeat;
  std::vector<OtherCondition> others;
};

/// A parameter of a stored fit, in `unit`. What is not known is NaN.
struct ResultParameter : FittedValue {
  std::string name = {}, unit = {};
  std::string effect = {};  ///< key; empty for the base law
  double range_lower = std::numeric_limits<double>::quiet_NaN(),
         range_upper = range_lower;  ///< see FitParameter::range
  double lower = 0, upper = 0;       ///< bounds of the search

  /// Its error is known, and it is not on a bound.
  bool has_error() const { return std_error > 0 && std_error < std::numeric_limits<double>::infinity() && !at_bound; }
};

/// Name by which a parameter or a measure is known in tables: "mu_s", and "runout.A" for one of an effect.
inline std::string full_name(const std::string& name, const std::string& effect) {
  return effect.empty() ? name : effect + "." + name;
}

/// A stored fit. What is not known is NaN.
struct ResultFit : FitSummary {
  struct Correlated {
    std::array<std::string, 2> parameters;
    double value = 0;
  };

  std::string law, protocol;  ///< "exponential", "joint"
  std::vector<std::string> effects, effect_names;
  std::vector<ResultParameter> parameters;
  std::vector<Correlated> correlations;         ///< those above 0.9 in size
  std::vector<std::vector<double>> covariance;  ///< statistical, in the units of the parameters; empty: not known
  bool conditional = false;
  std::size_t samples = 0;
};

/// The result of one run as its file has it: made of an analysis, or read back.
struct RunResult {
  static constexpr Estimate not_known = {std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::quiet_NaN()};

  RunRecord run;
  std::size_t position = 0;     ///< in the campaign, from 0
  std::optional<double> order;  ///< rank in time from 0 (ties share their mean), where a condition says it, see below
  Conditions conditions;        ///< as used [SI]
  std::string path;             ///< of the trace
  std::string friction_unit = "1";  ///< "N" where friction is a force
  std::size_t samples = 0;
  double duration = 0, rate = 0;  ///< [s], [Hz]
  std::string checksum;           ///< of the values of the trace; empty where it was not read

  std::size_t cycles = 0;
  Estimate frequency = not_known;   ///< [Hz]
  Estimate amplitude = not_known;   ///< of v_r [mm/s]
  Estimate stick_time = not_known;  ///< [s]
  Estimate slip_time = not_known;   ///< [s]
  double rms_velocity = 0;          ///< of the block [mm/s]

  std::vector<ResultFit> fits;
  std::size_t best = 0;  ///< index in fits
  std::vector<std::string> warnings;

  bool was_read() const { return run.status != RunStatus::unreadable; }
  /// As used, or as stated where the trace was not read.
  const Conditions& known_conditions() const { return was_read() ? conditions : run.conditions; }
  /// The fit of that law and protocol; null where there is none with parameters.
  const ResultFit* fit(std::string_view law, std::string_view protocol) const;
};

/// Of each law the first joint fit with parameters, to know them; with their covariance, where that is asked for.
std::vector<const ResultFit*> joint_fits(std::span<const RunResult> runs, bool with_covariance = false);

/// A JSON object with its own checksum as last key, which shows a cut or damaged file.
std::string sealed(std::string_view json);

/// Whether a text is one that sealed() made, to the last byte.
bool is_whole(std::string_view text);

/// What a campaign is made of, what its runs are and what they say together, in the folder of its results.
inline constexpr const char *campaign_name = "campaign.json", *summary_name = "summary.json",
                            *pooled_name = "pooled.json";
/// All of the campaign's own that end as the results of runs do: no run is called like one of them.
inline constexpr std::array campaign_files = {campaign_name, summary_name, pooled_name};
/// Beside the results, what figures and fits of all runs together take of the samples: many numbers that few ask for,
/// in files of their own, with the hash of the run's settings.
inline constexpr const char* kept_folder = "kept";

/// CampaignPlan::folder of a folder of results; nothing where campaign.json is missing or damaged. Never throws.
std::optional<std::string> folder_of_campaign(const std::string& results);

/// Reads the record of one result file; nothing where the file is missing, damaged or of another make. Never
/// throws.
std::optional<RunRecord> read_record(const std::string& path);

/// A run in campaign.json: name and file as in Run, hash of its settings as in RunRecord.
struct PlannedRun {
  std::string name, file, settings;
};

/// campaign.json: what was planned.
struct CampaignPlan {
  std::string folder;  ///< of the traces, seen from that of the results: both may move; empty: named one by one
  std::vector<PlannedRun> runs;
  std::vector<std::string> problems;  ///< rows of the manifest that name no run of their own
};

/// The results of a campaign one after the other, so that memory does not grow with what they hold.
class ResultReader {
 public:
  /// Throws InputError where the folder holds no campaign, or one that is damaged.
  explicit ResultReader(std::string folder);

  const std::string& folder() const { return folder_; }
  const CampaignPlan& plan() const { return plan_; }
  std::size_t size() const { return plan_.runs.size(); }  ///< runs of the campaign
  /// The result of the k-th run, without its order in time; nothing where it is missing.
  std::optional<RunResult> read(std::size_t k) const;
  /// The figures kept with the result that read() returns; nothing where it could not be analysed.
  std::optional<RunFigures> figures(std::size_t k) const;
  /// The condensed run kept with it; nothing where it could not be analysed, or was kept by an earlier version.
  std::optional<CondensedRun> condensed(std::size_t k) const;

 private:
  std::string folder_;
  CampaignPlan plan_;
};

/// Reads all results of a campaign; `order` comes from the first further condition that is called order, run
/// order, sequence, date, time, timestamp, start or the like and that every run states (numbers by size, else as text,
/// which puts ISO dates in order). Copies count once. Throws InputError where the folder holds no campaign. Cost:
/// linear in runs.
std::vector<RunResult> read_results(const std::string& folder);

/// Of runs that hold the same values (a copy of a file is no repeat) the first counts: the others become failed,
/// without fits, and their message says so.
void count_copies_once(std::vector<RunResult>& runs);

}  // namespace tribofit
