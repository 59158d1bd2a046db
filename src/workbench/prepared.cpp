#include "prepared.hpp"

#include <algorithm>
#include <utility>

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

TracePart Prepared::part(const Selection& selection) const {
  TracePart out = whole_;
  exclude(selection, drawn_.motion, out.segmentation);
  const auto said = out.segmentation.notes.begin() + static_cast<std::ptrdiff_t>(whole_.segmentation.notes.size());
  out.notes.insert(out.notes.end(), said, out.segmentation.notes.end());
  return out;
}

Report Prepared::draw(TracePart part, const Selection& selection, ReportOptions options,
                      std::shared_ptr<const ReportSection>& cycles) {
  const std::lock_guard lock(drawing_);
  static_cast<TracePart&>(drawn_) = std::move(part);
  cycles = cycles_of(selection);
  options.leave_out_cycles = true;
  return report_of(drawn_, options);
}

std::shared_ptr<const ReportSection> Prepared::cycles_of(const Selection& selection) {
  constexpr std::size_t kMostKept = 4;  // pages look at a few parts of a record
  for (const Drawn& known : kept_) {
    if (same_part(known.selection, selection)) return known.cycles;
  }
  if (kept_.size() >= kMostKept) kept_.erase(kept_.begin());
  kept_.push_back({selection, std::make_shared<const ReportSection>(cycles_section(drawn_))});
  return kept_.back().cycles;
}

}  // namespace tribofit::workbench
