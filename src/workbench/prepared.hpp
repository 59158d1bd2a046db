#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "tribofit/fit/identification.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit::workbench {

/// Whether two selections are of the same part of a record.
bool same_part(const Selection& a, const Selection& b);

/// A trace with one set of corrections of its motion. Its motion does not change and is shared by every fit; what is
/// drawn of it is drawn one at a time.
class Prepared {
 public:
  explicit Prepared(Identification prepared);

  const Motion& motion() const { return drawn_.motion; }

  /// The part that is selected, as before any fit, with its noise; its cycles are drawn meanwhile.
  TracePart part(const Selection& selection, int threads);

  /// The report of a part, but for its section of the cycles, which stands beside it.
  Report draw(TracePart part, const Selection& selection, ReportOptions options,
              std::shared_ptr<const ReportSection>& cycles);

 private:
  /// What no model changes of a part that was looked at.
  struct Seen {
    Selection selection;
    std::optional<RecordNoise> noise;
    std::shared_ptr<const ReportSection> cycles;
  };

  Seen& seen(const Selection& selection);
  /// The section of the cycles of the part in drawn_.
  std::shared_ptr<const ReportSection> drawn_cycles() const;

  Identification drawn_;  ///< its part is the one that was drawn last
  const TracePart whole_;
  std::vector<Seen> kept_;
  std::mutex looking_;  ///< guards drawn_ and kept_
};

}  // namespace tribofit::workbench
