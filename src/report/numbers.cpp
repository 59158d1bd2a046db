#include "numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tribofit {
namespace {

constexpr int kMostPlaces = 8;

/// Power of ten of the first digit, after rounding to `digits` digits (0.0996 to two digits is 0.10).
int leading_power(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return 0;
  const std::string text = fmt::format("{:.{}e}", std::abs(value), digits - 1);
  return std::stoi(text.substr(text.find('e') + 1));
}

}  // namespace

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  if (value == 0) return "0";
  const int power = leading_power(value, digits);
  if (power < -4 || power > 6) return fmt::format("{:.{}e}", value, digits - 1);
  return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - power));
}

std::string brief(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

int places_for(double std_error) {
  if (!std::isfinite(std_error) || std_error <= 0) return kMostPlaces;
  return 1 - leading_power(std_error, 2);
}

std::string fixed(double value, int places) {
  if (!std::isfinite(value)) return "-";
  if (places >= 0) return fmt::format("{:.{}f}", value, std::min(places, 12));
  const double step = std::pow(10.0, -places);
  return fmt::format("{:.0f}", std::round(value / step) * step);
}

std::string with_error(double value, double std_error) {
  if (!std::isfinite(value)) return "-";
  if (!std::isfinite(std_error) || std_error <= 0) return significant(value, 4);
  constexpr double kAbsurd = 1e-6;  // more than six digits of a measured value mislead
  if (std_error < kAbsurd * std::abs(value)) return significant(value, 6) + " +/- " + significant(std_error, 1);
  const int places = places_for(std_error);
  return fixed(value, places) + " +/- " + fixed(std_error, places);
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "-";
  const double value = 100 * share;
  const double size = std::abs(value);
  if (size >= 10) return fmt::format("{:.0f} %", value);
  if (size >= 1) return fmt::format("{:.1f} %", value);
  if (size >= 0.01) return fmt::format("{:.2f} %", value);
  if (size >= 0.001) return fmt::format("{:.3f} %", value);
  return value == 0 ? "0 %" : "< 0.001 %";
}

std::string share_text(double share) {
  if (!std::isfinite(share)) return "-";
  const int decimals = share > 0.9995 ? 2 : 1;
  const double step = std::pow(10.0, -decimals);
  return fmt::format("{:.{}f} %", std::floor(100 * share / step) * step, share >= 1 ? 0 : decimals);
}

std::string grouped(std::size_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, " ");
  return text;
}

std::string rate_text(double hertz) {
  if (!std::isfinite(hertz)) return "-";
  return hertz >= 1000 ? fmt::format("{:.4g} kHz", hertz / 1000) : fmt::format("{:.4g} Hz", hertz);
}

std::string friction_unit(const Motion& motion) {
  return motion.friction_kind == FrictionKind::force ? "N" : "1";
}

std::string shown_unit(const FitParameter& parameter, const Motion& motion) {
  const std::string& unit = parameter.parameter.unit;
  const bool level = parameter.parameter.scales_with_friction || (parameter.effect.empty() && unit == "1");
  const bool in_newtons = unit.rfind('N', 0) == 0;  // a fit to forces says so itself
  if (!level || in_newtons || motion.friction_kind != FrictionKind::force) return unit;
  if (unit == "1") return "N";
  return unit.rfind("1/", 0) == 0 ? "N" + unit.substr(1) : "N " + unit;
}

double shown(const FitParameter& parameter, double value_in_si) {
  return value_in_si / parameter.parameter.si;
}

Table::Table(std::vector<std::string> header, std::vector<bool> left) : left_(std::move(left)) {
  left_.resize(header.size(), false);
  left_.front() = true;
  rows_.push_back(std::move(header));
}

void Table::add(std::vector<std::string> row) {
  row.resize(rows_.front().size());
  rows_.push_back(std::move(row));
}

std::vector<std::size_t> Table::widths() const {
  std::vector<std::size_t> width(rows_.front().size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t k = 0; k < row.size(); ++k) width[k] = std::max(width[k], displayed(row[k]));
  }
  return width;
}

std::size_t Table::width() const {
  std::size_t sum = 0;
  for (const std::size_t column : widths()) sum += column + 2;
  return sum - 2;
}

std::string Table::text(std::size_t indent, std::string_view header_on, std::string_view header_off) const {
  const std::vector<std::size_t> width = widths();
  std::string result;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    std::string line(indent, ' ');
    for (std::size_t k = 0; k < rows_[i].size(); ++k) {
      const std::string gap(width[k] - displayed(rows_[i][k]), ' ');
      if (k > 0) line += "  ";
      line += left_[k] ? rows_[i][k] + gap : gap + rows_[i][k];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    result += i == 0 ? std::string(header_on) + line + std::string(header_off) : line;
    result += '\n';
  }
  return result;
}

std::string wrapped(std::string_view sentence, std::size_t width, std::size_t indent) {
  std::string result;
  std::size_t column = indent;
  while (!sentence.empty()) {
    const std::size_t blank = sentence.find(' ');
    const std::string_view word = sentence.substr(0, blank);
    const std::size_t length = displayed(word);
    if (column > indent) {
      const bool fits = column + 1 + length <= width;
      result += fits ? std::string(" ") : "\n" + std::string(indent, ' ');
      column = fits ? column + 1 : indent;
    }
    result += word;
    column += length;
    sentence.remove_prefix(blank == std::string_view::npos ? sentence.size() : blank + 1);
  }
  return result;
}

namespace {

/// The words of a command; a quoted one stays whole.
std::vector<std::string> words_of(const std::string& command) {
  std::vector<std::string> words(1);
  bool quoted = false;
  for (const char c : command) {
    if (c == '\'') quoted = !quoted;
    if (c == ' ' && !quoted) {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

}  // namespace

std::size_t displayed(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string folded_command(const std::string& command, std::size_t width) {
  constexpr std::size_t kIndent = 2, kContinued = 6;
  std::string text(kIndent, ' ');
  std::size_t column = kIndent;
  for (const std::string& word : words_of(command)) {
    const bool first = column == kIndent;
    const std::size_t length = displayed(word);
    if (!first && column + 1 + length + 2 > width) {
      text += " \\\n" + std::string(kContinued, ' ') + word;
      column = kContinued + length;
      continue;
    }
    text += (first ? "" : " ") + word;
    column += length + (first ? 0 : 1);
  }
  return text;
}

}  // namespace tribofit
