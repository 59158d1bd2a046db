#pragma once

#include <span>
#include <string_view>

namespace tribofit {

/// The page around its data, in pieces that a compiler takes as string literals: up to the title, between title and
/// data, and behind the data. All empty in a build without the page.
struct PageParts {
  std::span<const std::string_view> head, middle, tail;
};
PageParts page_parts();

}  // namespace tribofit
