#include "tribofit/campaign/batch.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <mutex>
#include <new>
#include <utility>

#include "ingest/content_hash.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"

namespace tribofit {
namespace {

/// What shows without reading whether a file is another or was written to: bytes, place and times. The time of change
/// counts, too: that of modification is kept by those who copy.
using FileState = std::array<std::int64_t, 7>;

FileState state_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {status.st_size,
          static_cast<std::int64_t>(status.st_dev),
          static_cast<std::int64_t>(status.st_ino),
          status.st_mtim.tv_sec,
          status.st_mtim.tv_nsec,
          status.st_ctim.tv_sec,
          status.st_ctim.tv_nsec};
}

/// Keeps the traces that are in memory at the same time below a number of bytes; one alone may have more.
class Admission {
 public:
  explicit Admission(std::uint64_t limit) : limit_(limit) {}
  void enter(std::uint64_t bytes) {
    std::unique_lock lock(mutex_);
    room_.wait(lock, [&] { return inside_ == 0 || inside_ + bytes <= limit_; });
    inside_ += bytes;
  }
  void leave(std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    inside_ -= bytes;
    room_.notify_all();
  }

 private:
  std::uint64_t limit_, inside_ = 0;
  std::mutex mutex_;
  std::condition_variable room_;
};

std::string with_place(const InputError& error, const Run& run) {
  InputLocation where = error.where();
  if (where.file == run.trace.path) where.file = run.file;  // results do not depend on how the folder was named
  return InputError(error.problem(), error.advice(), where).what();
}

class Batch {
 public:
  Batch(const Campaign& campaign, const BatchOptions& options, const BatchHooks& hooks)
      : options_(options), hooks_(hooks), admission_(options.bytes_at_once), options_hash_(options_hash(options)) {
    for (std::size_t k = 0; k < campaign.runs.size(); ++k) {
      if (k % options.shard.count + 1 != options.shard.index) continue;
      outcome_.ends.emplace_back().run = &campaign.runs[k];
      bytes_.push_back(static_cast<std::uint64_t>(state_of(campaign.runs[k].trace.path).front()));
      progress_.left_bytes += bytes_.back();
    }
    progress_.total = outcome_.ends.size();
    threads_ = static_cast<std::size_t>(options.threads > 0 ? options.threads : available_threads());
  }

  BatchOutcome run() {
    run_tasks(outcome_.ends.size(), static_cast<int>(threads_), [&](std::size_t k) { end_run(k); });
    for (const RunEnd& end : outcome_.ends) {
      if (!end.begun) {
        outcome_.stopped = true;
      } else if (end.status != RunStatus::ok || !end.kept) {
        ++outcome_.failed;
      } else {
        ++(end.present ? outcome_.present : outcome_.fitted);
      }
    }
    return std::move(outcome_);
  }

 private:
  void end_run(std::size_t k) {
    RunEnd& end = outcome_.ends[k];
    end.begun = unwritten_in_a_row_ < kMostUnwritten;
    if (!end.begun) return;
    const FileState before = state_of(end.run->trace.path);
    RunRecord record = record_of(*end.run);
    end.present = is_present(*end.run, record);
    if (!end.present) {
      admission_.enter(bytes_[k]);
      std::optional<Identification> result;
      if (record.status == RunStatus::ok) result = analysis_of_what_stays(*end.run, k, before, record);
      keep(record, result, end);
      admission_.leave(bytes_[k]);
    }
    end.status = record.status;
    if (end.kept) end.message = record.message;
    report_progress(k, end);
  }

  RunRecord record_of(const Run& run) const {
    RunRecord record;
    record.name = run.name;
    record.file = run.file;
    record.settings = settings_hash(run, options_hash_);
    record.conditions = run.trace.read.conditions;
    record.repeat = run.known.repeat;
    record.others = run.known.others;
    return record;
  }

  /// Finds the key of the run by reading its files, and whether its result is there; takes over what that says.
  bool is_present(const Run& run, RunRecord& record) const {
    record.status = RunStatus::unreadable;
    record.message = run.problem;
    record.key = hexadecimal(xxh64(record.settings));
    if (!run.problem.empty()) return false;
    try {
      record.key = key_of(run, record);
    } catch (const InputError& error) {
      record.message = with_place(error, run);
      return false;
    }
    record.status = RunStatus::ok;
    if (options_.again) return false;
    const auto found = read_record(result_path(options_.results, run.name));
    if (!found || found->key != record.key || found->status == RunStatus::unreadable) return false;
    record.status = found->status;
    record.message = found->message;
    return true;
  }

  static std::string key_of(const Run& run, const RunRecord& record) {
    return hexadecimal(xxh64(record.settings, content_hash(std::vector{run.trace.path})));
  }

  void keep(const RunRecord& record, const std::optional<Identification>& result, RunEnd& end) {
    try {
      hooks_.keep(record, result ? &*result : nullptr);
      unwritten_in_a_row_ = 0;
    } catch (const std::exception& error) {
      end.kept = false;
      end.message = error.what();
      ++unwritten_in_a_row_;
    }
  }

  /// The analysis of the bytes that the key of the record is of: again, where the file changed meanwhile.
  std::optional<Identification> analysis_of_what_stays(const Run& run, std::size_t k, FileState before,
                                                       RunRecord& record) const {
    constexpr int kMostTries = 3;
    for (int tries = 0; tries < kMostTries; ++tries) {
      record.status = RunStatus::ok;
      record.message.clear();
      try {
        if (tries > 0) {
          before = state_of(run.trace.path);
          record.key = key_of(run, record);
        }
        std::optional<Identification> result = analysis_of(run, k, record);
        if (state_of(run.trace.path) == before) return result;
      } catch (const InputError& error) {  // of the hash: gone meanwhile
        record.message = with_place(error, run);
      }
    }
    record.status = RunStatus::unreadable;
    if (record.message.empty())
      record.message = run.file + ": changed each time it was read; run again when it is complete";
    return std::nullopt;
  }

  std::optional<Identification> analysis_of(const Run& run, std::size_t k, RunRecord& record) const {
    try {
      IdentifyOptions own = options_.identify;
      own.read = run.trace.read;
      own.threads = own.read.threads = threads_inside(bytes_[k]);
      Identification result = identify(run.trace.path, own);
      result.path = run.file;
      result.warnings.insert(result.warnings.begin(), run.warnings.begin(), run.warnings.end());
      record.message = failure_of(result);
      if (!record.message.empty()) record.status = RunStatus::failed;
      return result;
    } catch (const InputError& error) {
      record.message = with_place(error, run);
    } catch (const std::bad_alloc&) {
      record.message = run.file + ": there is not enough memory for it; use fewer --threads";
    } catch (const std::exception& error) {  // whatever it is, it is this run's alone
      record.message = run.file + ": " + error.what();
    }
    record.status = RunStatus::unreadable;
    return std::nullopt;
  }

  /// A trace so long that it leaves no memory for others gets the threads that would be theirs.
  int threads_inside(std::uint64_t bytes) const {
    const std::uint64_t beside = std::clamp<std::uint64_t>(options_.bytes_at_once / std::max<std::uint64_t>(bytes, 1),
                                                           1, std::min(threads_, outcome_.ends.size()));
    return static_cast<int>(std::max<std::uint64_t>(1, threads_ / beside));
  }

  void report_progress(std::size_t k, const RunEnd& end) {
    const std::lock_guard lock(reporting_);
    ++progress_.done;
    progress_.left_bytes -= bytes_[k];
    if (!end.present) progress_.fitted_bytes += bytes_[k];
    progress_.name = end.run->name;
    if (hooks_.progress) hooks_.progress(progress_);
  }

  /// A disc that takes none of so many results in a row is full or gone: there is no use in fitting on.
  static constexpr int kMostUnwritten = 8;

  const BatchOptions& options_;
  const BatchHooks& hooks_;
  Admission admission_;
  std::string options_hash_;
  std::size_t threads_ = 1;
  std::vector<std::uint64_t> bytes_;  // of the trace of each end
  BatchOutcome outcome_;
  std::atomic<int> unwritten_in_a_row_ = 0;
  std::mutex reporting_;
  BatchProgress progress_;
};

}  // namespace

std::string failure_of(const Identification& result) {
  const bool fitted =
      std::ranges::any_of(result.fits, [](const Fit& fit) { return fit.converged && !fit.parameters.empty(); });
  const bool driven = result.rate_state && result.rate_state->fitted();
  if (result.analysed && (fitted || driven)) return "";
  return result.warnings.empty() ? "no fit converged" : result.warnings.back();
}

std::string result_path(const std::string& results, const std::string& name) {
  return (std::filesystem::path(results) / (name + ".json")).string();
}

BatchOutcome run_batch(const Campaign& campaign, const BatchOptions& options, const BatchHooks& hooks) {
  return Batch(campaign, options, hooks).run();
}

}  // namespace tribofit
