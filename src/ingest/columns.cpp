#include "columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <initializer_list>

#include "column_names.hpp"
#include "spelling.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

constexpr std::array<std::string_view, channel_count> channel_names = {
    "time", "mu", "v_b", "v_r", "force", "torque", "load", "speed", "angle", "temperature", "step"};

/// What one user asks of one channel.
struct Request {
  std::string column;  // empty: find it; "none": leave it out
  std::string unit;    // empty: from the file
  bool ignored() const { return column == "none"; }
};
using Requests = std::array<std::optional<Request>, channel_count>;

class Finder {
 public:
  Finder(const Dialect& dialect, const ReadOptions& options, const std::string& path)
      : dialect_(dialect), path_(path), two_files_(!options.second_file.empty()), has_rate_(options.rate.has_value()) {
    read_requests(options);
  }

  Columns find() {
    for (std::size_t i = 0; i < channel_count; ++i) {
      const auto& request = requests_[i];
      if (!request || request->column.empty() || request->ignored()) continue;
      try {
        taken_[i] = column_index(request->column, static_cast<Channel>(i));
      } catch (const InputError&) {
        if (!two_files_) throw;
      }
    }
    for (std::size_t i = 0; i < channel_count; ++i) recognise(static_cast<Channel>(i));
    choose_one({Channel::mu, Channel::force, Channel::torque});
    choose_one({Channel::v_b, Channel::v_r});
    for (std::size_t i = 0; i < channel_count; ++i) {
      if (taken_[i]) convert(static_cast<Channel>(i), *taken_[i]);
    }
    std::sort(result_.used.begin(), result_.used.end(),
              [](const Column& a, const Column& b) { return a.index < b.index; });
    note_unused();
    return std::move(result_);
  }

 private:
  InputLocation header(const std::string& column = {}) const { return {path_, dialect_.header_line, column}; }

  void read_requests(const ReadOptions& options) {
    const std::vector<std::string> known(channel_names.begin(), channel_names.end());
    const auto slot = [&](const std::string& name, const char* option) -> Request& {
      const auto at = std::find(known.begin(), known.end(), name);
      if (at == known.end()) {
        throw InputError(fmt::format("{}: unknown channel '{}'{}", option, name, did_you_mean(name, known)),
                         "channels are " + listed(known));
      }
      auto& request = requests_[static_cast<std::size_t>(at - known.begin())];
      if (!request) request.emplace();
      return *request;
    };
    for (const auto& [name, text] : options.columns) {
      Request& request = slot(name, "--columns");
      request.column = text.empty() ? "none" : text;
      const std::size_t colon = text.rfind(':');
      if (colon != std::string::npos && !exists(text)) {
        request.column = std::string(trimmed(std::string_view(text).substr(0, colon)));
        request.unit = std::string(trimmed(std::string_view(text).substr(colon + 1)));
      }
    }
    for (const auto& [name, text] : options.units) slot(name, "--units").unit = std::string(trimmed(text));
  }

  bool exists(const std::string& name) const {
    return std::find(dialect_.names.begin(), dialect_.names.end(), name) != dialect_.names.end();
  }

  std::size_t column_index(const std::string& wanted, Channel channel) const {
    const auto& names = dialect_.names;
    const auto exact = std::find(names.begin(), names.end(), wanted);
    if (exact != names.end()) return static_cast<std::size_t>(exact - names.begin());
    if (wanted.size() > 1 && wanted[0] == '#') {
      std::size_t number = 0;
      const char* end = wanted.data() + wanted.size();
      const auto [last, error] = std::from_chars(wanted.data() + 1, end, number);
      if (error == std::errc{} && last == end && number >= 1 && number <= dialect_.columns) return number - 1;
      throw InputError(fmt::format("there is no column {} for {}", wanted, to_string(channel)),
                       fmt::format("the file has {} columns, #1 to #{}", dialect_.columns, dialect_.columns), header());
    }
    std::vector<std::size_t> similar;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool same_name = lower_case(names[i]) == lower_case(wanted);
      if (same_name || parse_column_name(names[i]).base == parse_column_name(wanted).base) similar.push_back(i);
    }
    if (similar.size() == 1) return similar.front();
    throw InputError(
        fmt::format("there is no column '{}' for {}{}", wanted, to_string(channel), did_you_mean(wanted, names)),
        "the columns are: " + listed(names), header());
  }

  bool is_taken(std::size_t column) const {
    return std::any_of(taken_.begin(), taken_.end(), [&](const auto& t) { return t && *t == column; });
  }

  /// Takes the column with the most usual of the channel's names, if there is one.
  void recognise(Channel channel) {
    auto& taken = taken_[index_of(channel)];
    const auto& request = requests_[index_of(channel)];
    const bool is_time = channel == Channel::time;
    if (taken || dialect_.header_line == 0 || (request && request->ignored())) return;
    if (request && !request->column.empty() && !is_time) return;  // it is in the other file
    if (is_time && has_rate_ && !two_files_) return;
    std::size_t best_rank = no_rank;
    std::vector<std::string> rivals;
    for (std::size_t i = 0; i < dialect_.names.size(); ++i) {
      const bool is_label = channel == Channel::step && !starts_with_number(i);  // "run-in"
      const std::size_t rank = is_taken(i) || is_label ? no_rank : rank_of(i, channel);
      if (rank == no_rank) continue;
      if (rank < best_rank) {
        rivals.clear();
        best_rank = rank;
        taken = i;
      } else if (rank == best_rank && channel != Channel::step) {
        rivals.push_back(dialect_.names[i]);
      }
    }
    if (!rivals.empty()) {
      result_.warnings.push_back(fmt::format("{} is read from column {}; {} could be it too (choose with --columns)",
                                             to_string(channel), dialect_.names[*taken], listed(rivals)));
    }
  }

  bool starts_with_number(std::size_t column) const {
    return column < dialect_.first_row.size() && is_number(dialect_.first_row[column], dialect_.decimal);
  }

  std::optional<std::string> unit_in_file(std::size_t column) const {
    const auto in_name = parse_column_name(dialect_.names[column]).unit;
    if (in_name && !in_name->empty()) return in_name;
    if (column < dialect_.units.size() && !dialect_.units[column].empty()) {
      return strip_brackets(dialect_.units[column]);
    }
    return in_name;
  }

  std::size_t rank_of(std::size_t column, Channel channel) const {
    std::optional<Quantity> quantity;
    if (const auto text = unit_in_file(column); text && !text->empty()) {
      if (const auto unit = find_unit(*text)) quantity = unit->quantity;
      if (quantity && find_unit(*text, Quantity::angular_velocity)) quantity = Quantity::angular_velocity;
    }
    return name_rank(parse_column_name(dialect_.names[column]).base, channel, quantity);
  }

  /// Keeps the first present of several descriptions of one thing; what the user names comes before what is found.
  void choose_one(std::initializer_list<Channel> order) {
    const auto named = [&](Channel c) {
      const auto& request = requests_[index_of(c)];
      return request && !request->column.empty() && !request->ignored();
    };
    const bool any_named = std::any_of(order.begin(), order.end(), named);
    bool chosen = false;
    for (const Channel channel : order) {
      auto& taken = taken_[index_of(channel)];
      if (!taken) continue;
      if (chosen || (any_named && !named(channel))) {
        taken.reset();
      } else {
        chosen = true;
      }
    }
  }

  void convert(Channel channel, std::size_t index) {
    Column column{channel, index, dialect_.names[index]};
    const auto& request = requests_[index_of(channel)];
    const bool by_user = request && !request->unit.empty();
    const std::string unit = by_user ? request->unit : unit_in_file(index).value_or("");
    if (!find_conversion(column, unit, by_user)) return;
    result_.used.push_back(std::move(column));
  }

  /// Fills factor, offset and angular. False when the channel can be done without and its unit is not known.
  bool find_conversion(Column& column, const std::string& text, bool by_user) {
    const Channel channel = column.channel;
    if (channel == Channel::step) return true;
    if (text.empty()) return without_unit(column);
    const auto sensitivity = find_sensitivity(text, channel);
    if (sensitivity) {
      column.factor = *sensitivity;
      if (!by_user) return true;
      const auto in_file = unit_in_file(column.index);
      if (in_file && !in_file->empty()) column.factor *= find_unit(*in_file, Quantity::voltage).value_or(Unit{}).factor;
      return true;
    }
    for (const Quantity quantity : quantities(channel)) {
      if (const auto unit = find_unit(text, quantity)) {
        column.factor = unit->factor;
        column.offset = unit->offset;
        column.angular = quantity == Quantity::angular_velocity && channel != Channel::speed;
        return true;
      }
    }
    refuse_unit(column, text);
  }

  [[noreturn]] void refuse_unit(const Column& column, const std::string& text) const {
    const std::size_t line = dialect_.units_line > 0 ? dialect_.units_line : dialect_.header_line;
    const InputLocation where{path_, line, column.name};
    const std::string advice =
        fmt::format("say the unit of {0} with --units {0}={1}", to_string(column.channel), usual_unit(column.channel));
    const auto unit = find_unit(text);
    if (!unit) {
      const std::string nearest = suggest_unit(text);
      throw InputError(fmt::format("unknown unit '{}'", text),
                       (nearest.empty() ? "" : "did you mean " + nearest + "? otherwise ") + advice, where);
    }
    if (unit->quantity == Quantity::voltage) {
      throw InputError("is in volts",
                       fmt::format("say the sensitivity with --units {0}=\"5 {1}/V\"", to_string(column.channel),
                                   usual_unit(column.channel)),
                       where);
    }
    throw InputError(fmt::format("unit '{}' is {}, not {}", text, with_article(to_string(unit->quantity)),
                                 with_article(to_string(quantities(column.channel).front()))),
                     advice, where);
  }

  bool without_unit(Column& column) {
    switch (column.channel) {
      case Channel::mu:
      case Channel::step:
        return true;
      case Channel::v_b:
      case Channel::v_r:
      case Channel::speed:
      case Channel::angle:
        break;
      default:
        result_.notes.push_back(fmt::format("{} in column {} has no unit and was taken in {}",
                                            to_string(column.channel), column.name, si_unit(column.channel)));
        return true;
    }
    if (column.channel == Channel::speed && names_rpm(parse_column_name(column.name).base)) {
      column.factor = find_unit("rpm")->factor;
      return true;
    }
    const std::string advice =
        fmt::format("say it with --units {0}={1}", to_string(column.channel), usual_unit(column.channel));
    const bool needed = column.channel != Channel::angle && (column.channel != Channel::speed || !velocity_is_taken());
    if (needed || requests_[index_of(column.channel)]) {
      throw InputError("has no unit", advice, header(column.name));
    }
    result_.warnings.push_back(fmt::format("column {} has no unit and was not read; {}", column.name, advice));
    return false;
  }

  bool velocity_is_taken() const {
    return taken_[index_of(Channel::v_b)].has_value() || taken_[index_of(Channel::v_r)].has_value();
  }

  void note_unused() {
    if (dialect_.header_line == 0) return;
    std::vector<std::string> unused;
    for (std::size_t i = 0; i < dialect_.names.size(); ++i) {
      const bool used =
          std::any_of(result_.used.begin(), result_.used.end(), [&](const Column& c) { return c.index == i; });
      if (!used && !dialect_.names[i].empty()) unused.push_back(dialect_.names[i]);
    }
    if (!unused.empty()) result_.notes.push_back("columns not used: " + listed(unused));
  }

  const Dialect& dialect_;
  const std::string& path_;
  const bool two_files_;  // a column may be in the other one
  const bool has_rate_;
  Requests requests_;
  std::array<std::optional<std::size_t>, channel_count> taken_;
  Columns result_;
};

}  // namespace

std::string_view to_string(Channel channel) {
  return channel_names[index_of(channel)];
}

const Column* Columns::find(Channel channel) const {
  const auto at = std::find_if(used.begin(), used.end(), [&](const Column& c) { return c.channel == channel; });
  return at != used.end() ? &*at : nullptr;
}

Columns find_columns(const Dialect& dialect, const ReadOptions& options, const std::string& path) {
  return Finder(dialect, options, path).find();
}

}  // namespace tribofit
