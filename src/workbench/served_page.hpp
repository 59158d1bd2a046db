#pragma once

#include <string>

namespace tribofit::workbench {

/// The page of the workbench with the policy its answer carries.
struct ServedPage {
  std::string html, policy;
};
/// Throws InputError where this build has no page.
ServedPage served_page(const std::string& trace);

}  // namespace tribofit::workbench
