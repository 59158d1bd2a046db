#include "unit_spelling.hpp"

#include <array>
#include <optional>

#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

/// Torques of drives and wrenches, in which a mass stands for the force it weighs with ("ft-lb", "kg cm").
std::optional<std::string> torque_of_masses(std::string_view text) {
  std::string word;
  for (const char c : lower_case(text)) {
    if (std::string_view(" -.*").find(c) == std::string_view::npos) word += c;
  }
  static constexpr std::array<std::string_view, 11> torques = {"lb*ft", "ft*lb", "lb*in", "in*lb", "oz*in", "in*oz",
                                                               "kg*m",  "kg*cm", "kg*mm", "g*cm",  "g*mm"};
  for (const std::string_view torque : torques) {
    const std::size_t star = torque.find('*');
    const std::string first(torque.substr(0, star)), second(torque.substr(star + 1));
    const bool length_first = second == "lb" || second == "oz";
    const std::string &mass = length_first ? second : first, &length = length_first ? first : second;
    for (const char* ending : {"", "f", "s"}) {
      const std::string force = mass + ending;
      if (word == (length_first ? length + force : force + length)) return mass + "f*" + length;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string usual_spelling(std::string_view text) {
  std::string result(trimmed(text));
  static constexpr std::array<std::array<std::string_view, 2>, 17> spellings = {{{"\u00b5", "u"},
                                                                                 {"\u03bc", "u"},
                                                                                 {"\u00b7", "*"},
                                                                                 {"\u22c5", "*"},
                                                                                 {"\u00d7", "*"},
                                                                                 {"\u00b2", "^2"},
                                                                                 {"\u00b3", "^3"},
                                                                                 {"\u207b\u00b9", "^-1"},
                                                                                 {"\u00b9", "^1"},
                                                                                 {"\u2103", "degC"},
                                                                                 {"\u00b0C", "degC"},
                                                                                 {"\u00b0F", "degF"},
                                                                                 {"\u00b0", "deg"},
                                                                                 {"**", "^"},
                                                                                 {" per ", "/"},
                                                                                 {"N.m", "N*m"},
                                                                                 {"\u2212", "-"}}};
  for (const auto& [from, to] : spellings) result = replaced(std::move(result), from, to);
  return torque_of_masses(result).value_or(result);
}

}  // namespace tribofit
