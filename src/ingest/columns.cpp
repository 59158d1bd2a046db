#include "columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <map>
#include <set>

#include "column_names.hpp"
#include "load_point_columns.hpp"
#include "tribofit/ingest/channels.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

/// What the user asks of one channel.
struct Request {
  std::string column;  // empty: find it; "none": leave it out
  std::string unit;    // empty: from the file
  bool ignored() const { return column == "none"; }
};
using Requests = std::array<std::optional<Request>, channel_count>;

class Finder {
 public:
  Finder(const RawTable& table, const ReadOptions& options)
      : table_(table),
        two_files_(!options.second_file.empty()),
        needs_no_time_(options.rate.has_value() || options.kind == RecordKind::points),
        motion_is_stated_(options.kind || options.conditions.speed.known() || options.spring.stiffness.known()),
        is_driven_(is_driven_in_steps(options.kind)),
        is_spring_slider_(options.kind == RecordKind::spring_slider) {
    read_requests(options);
  }

  Columns find() {
    for (std::size_t i = 0; i < channel_count; ++i) {
      const auto& request = requests_[i];
      if (!request || request->column.empty() || request->ignored()) continue;
      try {
        taken_[i] = named_column(table_, request->column, static_cast<Channel>(i));
      } catch (const InputError&) {
        if (!two_files_) throw;
      }
    }
    refuse_two_roles();
    for (std::size_t i = 0; i < channel_count; ++i) recognise(static_cast<Channel>(i));
    if (is_driven_) find_load_point();
    if (!motion_is_stated_) find_only_displacement();
    if (is_spring_slider_) choose_one({Channel::spring, Channel::force, Channel::mu, Channel::torque});
    choose_one({Channel::mu, Channel::force, Channel::torque, Channel::spring});
    choose_one({Channel::v_b, Channel::v_r, Channel::x_b});
    settle_clocks();
    for (std::size_t i = 0; i < channel_count; ++i) {
      if (taken_[i]) convert(static_cast<Channel>(i), *taken_[i]);
    }
    for (const std::size_t time : other_times_) convert(Channel::time, time);
    std::sort(result_.used.begin(), result_.used.end(),
              [](const Column& a, const Column& b) { return a.index < b.index; });
    note_unused();
    return std::move(result_);
  }

 private:
  const RawColumn& column(std::size_t index) const { return table_.columns[index]; }

  void read_requests(const ReadOptions& options) {
    const std::vector<std::string> known = channel_names();
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
      const std::size_t colon = text.rfind(':'), open = text.rfind('['), at = colon != text.npos ? colon : open;
      if (at == text.npos || at == 0 || exists(text)) continue;
      request.column = std::string(trimmed(std::string_view(text).substr(0, at)));
      request.unit = strip_brackets(std::string_view(text).substr(at == colon ? at + 1 : at));
    }
    for (const auto& [name, text] : options.units) {
      const bool is_channel = std::find(known.begin(), known.end(), name) != known.end();
      (is_channel ? slot(name, "--units").unit : unit_of_column(name, known)) = std::string(trimmed(text));
    }
  }

  /// Where --units keeps the unit of a column of that name; of the other file, if it is in neither.
  std::string& unit_of_column(const std::string& name, std::vector<std::string> known) {
    const std::vector<std::string> names = table_.names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end() || two_files_) return units_of_columns_[static_cast<std::size_t>(found - names.begin())];
    known.insert(known.end(), names.begin(), names.end());
    throw InputError(fmt::format("--units: there is no channel or column '{}'{}", name, did_you_mean(name, known)),
                     "give the unit of a channel (v_b=mm/s) or of a column; " + lists_columns(table_.path),
                     {table_.path, table_.columns.empty() ? 0 : table_.columns.front().line, ""});
  }

  bool exists(const std::string& name) const {
    return std::any_of(table_.columns.begin(), table_.columns.end(),
                       [&](const RawColumn& c) { return c.name == name; });
  }

  void refuse_two_roles() const {
    for (std::size_t i = 0; i < channel_count; ++i) {
      for (std::size_t k = i + 1; k < channel_count; ++k) {
        if (!taken_[i] || taken_[i] != taken_[k]) continue;
        throw InputError(fmt::format("is named for {} and for {}", to_string(static_cast<Channel>(i)),
                                     to_string(static_cast<Channel>(k))),
                         "a column holds one channel: name another with --columns", table_.heading(*taken_[i]));
      }
    }
  }

  bool is_taken(std::size_t column) const {
    return std::any_of(taken_.begin(), taken_.end(), [&](const auto& t) { return t && *t == column; });
  }

  /// Takes the column with the most usual of the channel's names, if there is one.
  void recognise(Channel channel) {
    auto& taken = taken_[index_of(channel)];
    const auto& request = requests_[index_of(channel)];
    if (taken || is_left_out(channel)) return;
    if (request && !request->column.empty() && channel != Channel::time) return;  // it is in the other file
    if (channel == Channel::time && needs_no_time_ && !two_files_) return;
    if (channel == Channel::std_error && taken_[index_of(Channel::time)]) return;  // of points
    taken = most_usual(channel, std::nullopt);
  }

  bool is_left_out(Channel channel) const {
    return requests_[index_of(channel)] && requests_[index_of(channel)]->ignored();
  }

  bool is_taken_of(std::initializer_list<Channel> channels) const {
    return std::any_of(channels.begin(), channels.end(), [&](Channel c) { return taken_[index_of(c)].has_value(); });
  }

  /// Where the load point is all that moves, what is called a speed or a displacement is its own.
  void find_load_point() {
    for (const Channel channel : {Channel::v_b, Channel::v_r, Channel::x_b, Channel::speed, Channel::angle}) {
      if (!requests_[index_of(channel)]) taken_[index_of(channel)].reset();
    }
    auto &displacement = taken_[index_of(Channel::x_d)], &velocity = taken_[index_of(Channel::v_lp)];
    const auto is_free = [&](std::size_t i) { return !is_taken(i); };
    if (!displacement && !is_left_out(Channel::x_d)) displacement = find_plain_displacement(table_, is_free);
    if (!displacement && !velocity && !is_left_out(Channel::v_lp)) velocity = find_plain_velocity(table_, is_free);
  }

  /// A displacement, or a velocity in um/s, that is all the motion recorded beside friction may be of a load point.
  void find_only_displacement() {
    const Channel channel = taken_[index_of(Channel::v_b)] ? Channel::v_b : Channel::v_r;
    const auto& velocity = taken_[index_of(channel)];
    if (velocity && (requests_[index_of(channel)] || !may_be_of_load_point(column(*velocity)))) return;
    is_plain_[index_of(channel)] = velocity.has_value();
    auto& displacement = taken_[index_of(Channel::x_d)];
    if (is_left_out(Channel::x_d) || (displacement && !requests_[index_of(Channel::x_d)])) return;
    if (!is_taken_of({Channel::mu, Channel::force})) return;
    if (is_taken_of({Channel::x_b, Channel::v_lp, Channel::speed, Channel::angle, Channel::spring})) return;
    const auto is_free = [&](std::size_t i) { return !is_taken(i) && is_in_length(column(i)); };
    if (!displacement) displacement = find_plain_displacement(table_, is_free);
    is_plain_[index_of(Channel::x_d)] = true;
  }

  /// The column with the most usual of the channel's names, of all rows or of these.
  std::optional<std::size_t> most_usual(Channel channel, std::optional<std::size_t> rows) {
    std::optional<std::size_t> best;
    std::size_t best_rank = no_rank;
    std::vector<std::string> rivals;
    for (std::size_t i = 0; i < table_.columns.size(); ++i) {
      const bool is_label = channel == Channel::step && column(i).is_text;  // "run-in"
      const bool elsewhere = rows && column(i).rows != *rows;
      const std::size_t rank = !column(i).named || is_taken(i) || is_label || elsewhere ? no_rank : rank_of(i, channel);
      if (rank == no_rank) continue;
      if (rank < best_rank) {
        rivals.clear();
        best_rank = rank;
        best = i;
      } else if (rank == best_rank && channel != Channel::step &&
                 (channel != Channel::time ||
                  (column(i).rows == column(*best).rows && column(i).place == column(*best).place))) {
        rivals.push_back(column(i).shown_name());
      }
    }
    if (!rivals.empty()) {
      result_.warnings.push_back(fmt::format("{} is read from column {}; {} could be it too (choose with --columns)",
                                             to_string(channel), column(*best).shown_name(), listed(rivals)));
    }
    return best;
  }

  /// Rows of their own have a clock of their own: each set of rows that holds a channel keeps its time column.
  void settle_clocks() {
    if (table_.rows.size() < 2) return;
    auto& time = taken_[index_of(Channel::time)];
    std::set<std::size_t> sets;
    for (std::size_t i = 0; i < channel_count; ++i) {
      if (taken_[i] && i != index_of(Channel::time)) sets.insert(column(*taken_[i]).rows);
    }
    const bool of_no_channel = time && !sets.empty() && !sets.contains(column(*time).rows);
    if (of_no_channel) time.reset();
    const auto& request = requests_[index_of(Channel::time)];
    if ((request && request->ignored()) || (needs_no_time_ && !two_files_)) return;
    for (const std::size_t rows : sets) {
      if (time && column(*time).rows == rows) continue;
      if (const auto other = most_usual(Channel::time, rows)) other_times_.push_back(*other);
    }
  }

  std::size_t rank_of(std::size_t index, Channel channel) const {
    std::optional<Quantity> quantity;
    if (const auto text = unit_in_file(column(index)); text && !text->empty()) {
      if (const auto unit = find_unit(*text)) quantity = unit->quantity;
      if (quantity && find_unit(*text, Quantity::angular_velocity)) quantity = Quantity::angular_velocity;
    }
    return name_rank(parse_column_name(column(index).name).base, channel, quantity);
  }

  /// Keeps the first present of several descriptions of one thing; what the user names comes before what is found.
  void choose_one(std::initializer_list<Channel> order) {
    const auto named = [&](Channel c) {
      const auto& request = requests_[index_of(c)];
      return request && !request->column.empty() && !request->ignored();
    };
    const bool any_named = std::any_of(order.begin(), order.end(), named);
    bool is_found = false;
    for (const Channel channel : order) {
      auto& taken = taken_[index_of(channel)];
      if (!taken) continue;
      if (is_found || (any_named && !named(channel))) {
        taken.reset();
      } else {
        is_found = true;
      }
    }
  }

  void convert(Channel channel, std::size_t index) {
    Column used{channel, index, column(index).shown_name(), column(index).name};
    const auto& request = requests_[index_of(channel)];
    const auto of_column = units_of_columns_.find(index);
    const bool of_channel = request && !request->unit.empty();
    const bool by_user = of_channel || of_column != units_of_columns_.end();
    const std::string unit = of_channel ? request->unit
                             : by_user  ? of_column->second
                                        : unit_in_file(column(index)).value_or("");
    used.plain = is_plain_[index_of(channel)];
    used.requested = request.has_value();
    if (!find_conversion(used, unit, by_user)) return;
    result_.used.push_back(std::move(used));
  }

  /// Fills factor, offset and angular. False when the channel can be done without and its unit is not known.
  bool find_conversion(Column& used, const std::string& text, bool by_user) {
    const Channel channel = used.channel;
    if (channel == Channel::step) return true;
    if (text.empty()) return without_unit(used);
    const auto sensitivity = find_sensitivity(text, channel);
    if (sensitivity) {
      used.factor = *sensitivity;
      if (!by_user) return true;
      const auto in_file = unit_in_file(column(used.index));
      if (in_file && !in_file->empty()) used.factor *= find_unit(*in_file, Quantity::voltage).value_or(Unit{}).factor;
      return true;
    }
    for (const Quantity quantity : info_of(channel).quantities) {
      if (const auto unit = find_unit(text, quantity)) {
        used.factor = unit->factor;
        used.offset = unit->offset;
        used.angular = quantity == Quantity::angular_velocity && channel != Channel::speed;
        used.over_load = quantity == Quantity::dimensionless && channel == Channel::spring;
        used.stress = quantity == Quantity::pressure;
        return true;
      }
    }
    if (takes_other_quantity(used, text)) return true;
    refuse_unit(used, text);
  }

  /// A force that is given as the mass it weighs like, or over the load.
  bool takes_other_quantity(Column& used, const std::string& text) {
    const auto unit = find_unit(text);
    if (!unit || (used.channel != Channel::force && used.channel != Channel::load)) return false;
    if (unit->quantity == Quantity::mass) {
      used.factor = unit->factor * standard_gravity;
      result_.notes.push_back(fmt::format("{} in column {} is in {}, taken as the force it weighs with",
                                          to_string(used.channel), used.name, text));
      return true;
    }
    if (unit->quantity != Quantity::dimensionless || used.channel != Channel::force) return false;
    used.channel = Channel::mu;
    used.factor = unit->factor;
    result_.notes.push_back(fmt::format("the force in column {} is over the load: it is mu", used.name));
    return true;
  }

  [[noreturn]] void refuse_unit(const Column& used, const std::string& text) const {
    InputLocation where = table_.heading(used.index);
    if (column(used.index).unit_line > 0) where.line = column(used.index).unit_line;  // apart from the name
    const std::string advice =
        fmt::format("state the unit of {0} with --units {0}={1}", to_string(used.channel), info_of(used.channel).unit);
    const auto unit = find_unit(text);
    if (!unit) {
      const std::string nearest = suggest_unit(text);
      throw InputError(fmt::format("unknown unit '{}'", text),
                       (nearest.empty() ? "" : "did you mean " + nearest + "? otherwise ") + advice, where);
    }
    if (unit->quantity == Quantity::voltage) {
      throw InputError("is in volts",
                       fmt::format("state the sensitivity with --units {0}=\"5 {1}/V\"", to_string(used.channel),
                                   info_of(used.channel).unit),
                       where);
    }
    throw InputError(fmt::format("unit '{}' is {}, not {}", text, with_article(to_string(unit->quantity)),
                                 with_article(to_string(*info_of(used.channel).quantities.begin()))),
                     advice, where);
  }

  bool without_unit(Column& used) {
    const ChannelInfo& channel = info_of(used.channel);
    if (channel.unitless == Unitless::friction) used.factor = friction_factor();
    if (channel.unitless == Unitless::si) {
      result_.notes.push_back(fmt::format("{} in column {} has no unit and was taken in {}", to_string(used.channel),
                                          used.name, channel.si_unit));
    }
    if (channel.unitless != Unitless::unknown) return true;
    if (used.channel == Channel::speed && names_rpm(parse_column_name(column(used.index).name).base)) {
      used.factor = find_unit("rpm")->factor;
      return true;
    }
    const bool is_machine = used.channel == Channel::x_d && names_load_point(used.plain_name);
    const std::string_view unit = is_machine ? "um" : info_of(used.channel).unit;
    const std::string advice = fmt::format("state it with --units {}={}", to_string(used.channel), unit);
    const bool velocity = taken_[index_of(Channel::v_b)] || taken_[index_of(Channel::v_r)];
    const bool needed = used.channel != Channel::angle && (used.channel != Channel::speed || !velocity);
    if (needed || requests_[index_of(used.channel)]) {
      throw InputError("has no unit", advice, table_.heading(used.index));
    }
    result_.warnings.push_back(fmt::format("column {} has no unit and was not read; {}", used.name, advice));
    return false;
  }

  double friction_factor() const {
    const Column* column = nullptr;
    for (const Channel channel : {Channel::mu, Channel::force, Channel::torque}) {
      if (column == nullptr) column = result_.find(channel);
    }
    return column == nullptr ? 1 : column->factor;
  }

  void note_unused() {
    std::vector<std::string> unused;
    for (std::size_t i = 0; i < table_.columns.size(); ++i) {
      const bool used =
          std::any_of(result_.used.begin(), result_.used.end(), [&](const Column& c) { return c.index == i; });
      if (!used && column(i).named) unused.push_back(column(i).shown_name());
    }
    if (!unused.empty()) result_.notes.push_back("columns not used: " + listed(unused));
  }

  const RawTable& table_;
  const bool two_files_;  // a column may be in the other one
  const bool needs_no_time_, motion_is_stated_, is_driven_, is_spring_slider_;
  Requests requests_;
  std::map<std::size_t, std::string> units_of_columns_;  // that the user states by the name of the column
  std::array<std::optional<std::size_t>, channel_count> taken_;
  std::array<bool, channel_count> is_plain_ = {};
  std::vector<std::size_t> other_times_;
  Columns result_;
};

}  // namespace

Columns find_columns(const RawTable& table, const ReadOptions& options) {
  return Finder(table, options).find();
}

}  // namespace tribofit
