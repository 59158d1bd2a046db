#pragma once

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "session_json.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit::workbench {

/// A trace with one set of corrections of its motion. Its motion does not change and is shared by every fit; what is
/// drawn of it is drawn one at a time.
class Prepared {
 public:
  explicit Prepared(Identification prepared) : drawn_(std::move(prepared)), whole_(drawn_) {}

  const Motion& motion() const { return drawn_.motion; }

  /// The part that is selected, as before any fit, with its noise.
  TracePart part(const Selection& selection, int threads) {
    TracePart out = whole_;
    exclude(selection, drawn_.motion, out.segmentation);
    const auto said = out.segmentation.notes.begin() + static_cast<std::ptrdiff_t>(whole_.segmentation.notes.size());
    out.notes.insert(out.notes.end(), said, out.segmentation.notes.end());
    const std::lock_guard lock(looking_);
    static_cast<TracePart&>(drawn_) = out;
    out.noise = seen(selection, threads).noise;
    return out;
  }

  /// The report of a part for a page.
  Report draw(TracePart part, const Selection& selection, ReportOptions options) {
    const std::lock_guard lock(looking_);
    static_cast<TracePart&>(drawn_) = std::move(part);
    options.cycles = &seen(selection, options.threads).cycles;
    Report report = report_of(drawn_, options);
    report.keep_for(Medium::page);
    return report;
  }

 private:
  /// What no model changes of a part that was looked at.
  struct Seen {
    Json selection;
    RecordNoise noise;
    ReportSection cycles;
  };
  /// Of the part in drawn_.
  const Seen& seen(const Selection& selection, int threads) {
    constexpr std::size_t kMostKept = 4;  // pages look at a few parts of a record
    const Json part = selection_json(selection);
    const auto known = std::ranges::find(kept_, part, &Seen::selection);
    if (known != kept_.end()) return *known;
    if (kept_.size() >= kMostKept) kept_.erase(kept_.begin());
    kept_.push_back({part, noise_of(drawn_.motion, drawn_.segmentation, threads), cycles_section(drawn_)});
    return kept_.back();
  }

  Identification drawn_;  ///< its part is the one that was drawn last
  const TracePart whole_;
  std::vector<Seen> kept_;
  std::mutex looking_;  ///< guards drawn_ and kept_
};

}  // namespace tribofit::workbench
