#include "clock_time.hpp"

#include <charconv>
#include <chrono>
#include <string>

namespace tribofit {
namespace {

/// Reads numbers and the signs between them from the left.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}
  bool is_at_end() const { return text_.empty(); }
  bool skip(char sign) {
    if (text_.empty() || text_.front() != sign) return false;
    text_.remove_prefix(1);
    return true;
  }
  /// A whole number of at most so many digits.
  std::optional<int> whole(std::size_t digits) {
    int value = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + std::min(digits, text_.size()), value);
    if (error != std::errc{} || value < 0 || *text_.data() == '-') return std::nullopt;
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }
  /// The digits behind a decimal point or comma, as a part of one; 0 where there is none.
  std::optional<double> fraction() {
    if (!skip('.') && !skip(',')) return 0.0;
    const std::size_t digits = std::min(text_.find_first_not_of("0123456789"), text_.size());
    double value = 0;
    const std::string decimal = "0." + std::string(text_.substr(0, digits));
    std::from_chars(decimal.data(), decimal.data() + decimal.size(), value);
    text_.remove_prefix(digits);
    return digits > 0 ? std::optional(value) : std::nullopt;
  }

 private:
  std::string_view text_;
};

/// Seconds of the days before a date, from 2020 on; behind it a blank or a T.
std::optional<double> seconds_of_date(Scanner& scanner, bool year_is_first) {
  const char sign = year_is_first ? '-' : '.';
  const auto first = scanner.whole(year_is_first ? 4 : 2);
  if (!first || !scanner.skip(sign)) return std::nullopt;
  const auto month = scanner.whole(2);
  if (!month || !scanner.skip(sign)) return std::nullopt;
  const auto last = scanner.whole(year_is_first ? 2 : 4);
  if (!last || !(scanner.skip(' ') || scanner.skip('T'))) return std::nullopt;
  const std::chrono::year_month_day date(std::chrono::year(year_is_first ? *first : *last),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(year_is_first ? *last : *first)));
  if (!date.ok()) return std::nullopt;
  using namespace std::chrono_literals;
  const auto days = std::chrono::sys_days(date) - std::chrono::sys_days(2020y / 1 / 1);
  return std::chrono::duration<double>(days).count();
}

}  // namespace

std::optional<double> clock_time(std::string_view cell) {
  if (cell.find(':') == std::string_view::npos) return std::nullopt;
  const bool year_is_first = cell.find('-') < cell.find(':');
  const bool has_date = cell.find_first_of(" T") < cell.find(':');
  Scanner scanner(cell);
  const std::optional<double> date = has_date ? seconds_of_date(scanner, year_is_first) : 0.0;
  if (!date) return std::nullopt;
  const auto hours = scanner.whole(2);
  if (!hours || !scanner.skip(':')) return std::nullopt;
  const auto minutes = scanner.whole(2);
  if (!minutes || !scanner.skip(':')) return std::nullopt;
  const auto seconds = scanner.whole(2);
  const auto part = scanner.fraction();
  if (!seconds || !part || !scanner.is_at_end()) return std::nullopt;
  if (*hours > 23 || *minutes > 59 || *seconds > 60) return std::nullopt;
  return *date + 3600 * *hours + 60 * *minutes + *seconds + *part;
}

}  // namespace tribofit
