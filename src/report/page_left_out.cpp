#include "page_parts.hpp"

namespace tribofit {

PageParts page_parts() {
  return {};
}

}  // namespace tribofit
