#include "report/pictures/draw.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

bool can_convert() {
  return false;
}

std::string converted(const std::string&, PictureFormat, const std::string&) {
  throw InputError("this build leaves out pictures as PDF and PNG",
                   "use --format svg, or build where librsvg is installed (scripts/setup figures)");
}

}  // namespace tribofit
