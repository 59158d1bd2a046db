#include "report/pictures/canvas.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

bool has_cairo() {
  return false;
}

std::unique_ptr<Canvas> make_cairo(PictureFormat, double, double, const std::string&) {
  throw InputError("this build leaves out pictures as PDF and PNG",
                   "use --format svg, or build where Cairo is installed (scripts/setup figures)");
}

}  // namespace tribofit
