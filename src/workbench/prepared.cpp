#include "prepared.hpp"

#include <algorithm>
#include <utility>

#include "tribofit/execution/parallel.hpp"

namespace tribofit::workbench {

bool same_part(const Selection& a, const Selection& b) {
  const auto ends = [](const Selection::Cycles& c) { return std::pair(c.first, c.last); };
  const auto alike = [](const Selection::Stretch& x, const Selection::Stretch& y) {
    return x.from == y.from && x.to == y.to;
  };
  const bool cycles = a.cycles && b.cycles ? ends(*a.cycles) == ends(*b.cycles) : !a.cycles && !b.cycles;
  return cycles && std::equal(a.excluded.begin(), a.excluded.end(), b.excluded.begin(), b.excluded.end(), alike);
}

Prepared::Prepared(Identification prepared) : drawn_(std::move(prepared)), whole_(drawn_) {}

TracePart Prepared::part(const Selection& selection, int threads) {
  TracePart out = whole_;
  exclude(selection, drawn_.motion, out.segmentation);
  const auto said = out.segmentation.notes.begin() + static_cast<std::ptrdiff_t>(whole_.segmentation.notes.size());
  out.notes.insert(out.notes.end(), said, out.segmentation.notes.end());
  const std::lock_guard lock(looking_);
  Seen& known = seen(selection);
  if (!known.noise) {
    static_cast<TracePart&>(drawn_) = out;
    RecordNoise noise;
    run_tasks(2, threads, [&](std::size_t k) {
      if (k == 0) noise = noise_of(drawn_.motion, drawn_.segmentation, threads);
      if (k == 1 && !known.cycles) known.cycles = drawn_cycles();
    });
    known.noise = noise;
  }
  out.noise = known.noise;
  return out;
}

Report Prepared::draw(TracePart part, const Selection& selection, ReportOptions options,
                      std::shared_ptr<const ReportSection>& cycles) {
  const std::lock_guard lock(looking_);
  static_cast<TracePart&>(drawn_) = std::move(part);
  std::shared_ptr<const ReportSection>& known = seen(selection).cycles;
  if (!known) known = drawn_cycles();  // meanwhile other pages looked at so many parts that this one was not kept
  cycles = known;
  options.leave_out_cycles = true;
  Report report = report_of(drawn_, options);
  report.keep_for(Medium::page);
  return report;
}

std::shared_ptr<const ReportSection> Prepared::drawn_cycles() const {
  return std::make_shared<const ReportSection>(cycles_section(drawn_));
}

Prepared::Seen& Prepared::seen(const Selection& selection) {
  constexpr std::size_t kMostKept = 4;  // pages look at a few parts of a record
  const auto known =
      std::find_if(kept_.begin(), kept_.end(), [&](const Seen& s) { return same_part(s.selection, selection); });
  if (known != kept_.end()) return *known;
  if (kept_.size() >= kMostKept) kept_.erase(kept_.begin());
  kept_.push_back({selection, {}, {}});
  return kept_.back();
}

}  // namespace tribofit::workbench
