#pragma once

#include <memory>
#include <string>

#include "tribofit/report/report.hpp"

namespace tribofit {

class WholeFolder;

/// Charts of a report as pictures for a paper: a file of each, as wide as a column of a journal (85 mm), with a
/// sans-serif face of 8 points and units in the titles of its axes. Their captions belong to the paper: figures.txt
/// beside them has title and note of each. SVG keeps its texts as text; PDF (with its letters) and PNG are made of it
/// by the command rsvg-convert of librsvg. What is where is the same in all of them, on every machine.

enum class PictureFormat { svg, pdf, png };
inline constexpr int kPicturePixelsPerInch = 600;  ///< of PNG

/// "svg", "pdf", "png".
std::string name_of(PictureFormat format);

/// Whether this format can be written: SVG always, PDF and PNG where rsvg-convert is installed.
bool can_write_pictures(PictureFormat format);

/// Pictures of all charts of a report, made and on the disc but without their names until commit().
///
/// Lines that the page shows only when its legend is used are left out. Names in the charts are shown as they are,
/// whatever they hold. Throws InputError where can_write_pictures() is false, WriteError where the folder cannot be
/// written; nothing is left then. Cost: linear in points, a few milliseconds for each picture.
class PictureFiles {
 public:
  PictureFiles(const Report& report, const std::string& folder, PictureFormat format);
  /// Gives the files their names: ID.svg (pdf, png) of each chart and figures.txt.
  void commit();

 private:
  std::shared_ptr<WholeFolder> folder_;
};

}  // namespace tribofit
