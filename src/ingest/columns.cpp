#include "columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>

#include "tribofit/ingest/channels.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

/// What the user asks of a channel, and the column that is found for it.
struct Wanted {
  bool asked = false;
  std::string name;  // of the column; empty: find it; "none": leave it out
  std::string unit;  // empty: from the file
  std::optional<std::size_t> column;
  bool plain = false;

  bool left_out() const { return name == "none"; }
  bool named() const { return !name.empty() && !left_out(); }
};

std::string key_of(Channel channel) {
  return std::string(to_string(channel));
}

class Finder {
 public:
  Finder(const RawTable& table, const ReadOptions& options)
      : table_(table),
        options_(options),
        two_files_(!options.second_file.empty()),
        needs_no_time_(options.rate.has_value() || options.kind == RecordKind::points) {
    for (const RawColumn& column : table.columns) labels_.push_back(label_of(column));
    read_requests();
  }

  Columns find() {
    for (const Channel channel : all_channels) find_named(channel);
    refuse_two_roles();
    for (const Channel channel : all_channels) recognise(channel);
    if (is_driven_in_steps(options_.kind)) find_load_point();
    if (!options_.kind && !options_.conditions.speed.known() && !options_.spring.stiffness.known())
      find_only_displacement();
    if (options_.kind == RecordKind::spring_slider)
      choose_one({Channel::spring, Channel::force, Channel::mu, Channel::torque});
    choose_one({Channel::mu, Channel::force, Channel::torque, Channel::spring});
    choose_one({Channel::v_b, Channel::v_r, Channel::x_b});
    settle_clocks();
    for (const Channel channel : all_channels) {
      if (of(channel).column) convert(channel, *of(channel).column);
    }
    for (const std::size_t time : other_times_) convert(Channel::time, time);
    std::ranges::sort(result_.used, {}, &Column::index);
    note_unused();
    return std::move(result_);
  }

 private:
  const RawColumn& column(std::size_t index) const { return table_.columns[index]; }
  Wanted& of(Channel channel) { return wanted_[index_of(channel)]; }
  const Wanted& of(Channel channel) const { return wanted_[index_of(channel)]; }

  void read_requests() {
    const std::vector<std::string> known = channel_names();
    const auto slot = [&](const std::string& name, std::string_view option) -> Wanted& {
      const auto at = std::find(known.begin(), known.end(), name);
      if (at == known.end()) {
        throw InputError(fmt::format("{}: unknown channel '{}'{}", setting(option), name, did_you_mean(name, known)),
                         "channels are " + listed(known));
      }
      Wanted& wanted = wanted_[static_cast<std::size_t>(at - known.begin())];
      wanted.asked = true;
      return wanted;
    };
    for (const auto& [name, text] : options_.columns) {
      Wanted& wanted = slot(name, "columns");
      wanted.name = text.empty() ? "none" : text;
      const std::size_t colon = text.rfind(':'), open = text.rfind('['), at = colon != text.npos ? colon : open;
      const bool exists = std::ranges::find(table_.columns, text, &RawColumn::name) != table_.columns.end();
      if (at == text.npos || at == 0 || exists) continue;
      wanted.name = std::string(trimmed(std::string_view(text).substr(0, at)));
      wanted.unit = strip_brackets(std::string_view(text).substr(at == colon ? at + 1 : at));
    }
    for (const auto& [name, text] : options_.units) {
      const bool is_channel = std::find(known.begin(), known.end(), name) != known.end();
      (is_channel ? slot(name, "units").unit : unit_of_column(name, known)) = std::string(trimmed(text));
    }
  }

  /// Where the unit of a column of that name is kept; of the other file, if it is in neither.
  std::string& unit_of_column(const std::string& name, std::vector<std::string> known) {
    const std::vector<std::string> names = table_.names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end() || two_files_) return units_of_columns_[static_cast<std::size_t>(found - names.begin())];
    known.insert(known.end(), names.begin(), names.end());
    throw InputError(
        fmt::format("{}: there is no channel or column '{}'{}", setting("units"), name, did_you_mean(name, known)),
        "give the unit of a channel (v_b=mm/s) or of a column; " + lists_columns(table_.path), table_.heading());
  }

  void find_named(Channel channel) {
    if (!of(channel).named()) return;
    try {
      of(channel).column = named_column(table_, of(channel).name, channel);
    } catch (const InputError&) {
      if (!two_files_) throw;
    }
  }

  void refuse_two_roles() const {
    std::map<std::size_t, Channel> role;
    for (const Channel channel : all_channels) {
      const auto& taken = of(channel).column;
      if (!taken) continue;
      const auto [other, is_first] = role.emplace(*taken, channel);
      if (is_first) continue;
      throw InputError(fmt::format("is named for {} and for {}", to_string(other->second), to_string(channel)),
                       "a column holds one channel: name another with " + setting("columns"), table_.heading(*taken));
    }
  }

  bool is_free(std::size_t column) const {
    return std::ranges::none_of(wanted_, [&](const Wanted& w) { return w.column == column; });
  }

  /// Takes the column with the most usual of the channel's names, if there is one.
  void recognise(Channel channel) {
    Wanted& wanted = of(channel);
    if (wanted.column || wanted.left_out()) return;
    if (wanted.named() && channel != Channel::time) return;  // it is in the other file
    if (channel == Channel::time && needs_no_time_ && !two_files_) return;
    if (channel == Channel::std_error && of(Channel::time).column) return;  // of points
    wanted.column = most_usual(channel, std::nullopt);
  }

  bool is_taken_of(std::initializer_list<Channel> channels) const {
    return std::ranges::any_of(channels, [&](Channel c) { return of(c).column.has_value(); });
  }

  /// The free column with the most usual of the plain names of a channel.
  std::optional<std::size_t> find_plain(Channel channel, std::optional<Quantity> quantity) const {
    for (const std::string& name : split(info_of(channel).plain, ' ')) {
      for (std::size_t i = 0; i < labels_.size(); ++i) {
        const bool fits = !quantity || labels_[i].quantity == quantity;
        if (column(i).named && fits && labels_[i].base == name && is_free(i)) return i;
      }
    }
    return std::nullopt;
  }

  /// Where the load point is all that moves, what is called a speed or a displacement is its own.
  void find_load_point() {
    for (const Channel channel : {Channel::v_b, Channel::v_r, Channel::x_b, Channel::speed, Channel::angle}) {
      if (!of(channel).asked) of(channel).column.reset();
    }
    Wanted &displacement = of(Channel::x_d), &velocity = of(Channel::v_lp);
    if (!displacement.column && !displacement.left_out()) displacement.column = find_plain(Channel::x_d, std::nullopt);
    if (!displacement.column && !velocity.column && !velocity.left_out())
      velocity.column = find_plain(Channel::v_lp, std::nullopt);
  }

  /// Whether a velocity is named plainly, and in a unit in which people measure creep: um/s or less.
  bool may_be_of_load_point(const Label& label) const {
    if (!is_among(label.base, info_of(Channel::v_lp).plain)) return false;
    const auto unit = find_unit(label.unit, Quantity::velocity);
    return unit && unit->factor < 2e-6;
  }

  /// A displacement, or a velocity in um/s, that is all the motion recorded beside friction may be of a load point.
  void find_only_displacement() {
    Wanted &velocity = of(of(Channel::v_b).column ? Channel::v_b : Channel::v_r), &displacement = of(Channel::x_d);
    if (velocity.column && (velocity.asked || !may_be_of_load_point(labels_[*velocity.column]))) return;
    velocity.plain = velocity.column.has_value();
    if (displacement.left_out() || (displacement.column && !displacement.asked)) return;
    if (!is_taken_of({Channel::mu, Channel::force})) return;
    if (is_taken_of({Channel::x_b, Channel::v_lp, Channel::speed, Channel::angle, Channel::spring})) return;
    if (!displacement.column) displacement.column = find_plain(Channel::x_d, Quantity::length);
    displacement.plain = true;
  }

  /// The column with the most usual of the channel's names, of all rows or of these.
  std::optional<std::size_t> most_usual(Channel channel, std::optional<std::size_t> rows) {
    std::optional<std::size_t> best;
    std::size_t best_rank = no_rank;
    std::vector<std::string> rivals;
    for (std::size_t i = 0; i < table_.columns.size(); ++i) {
      const bool is_label = channel == Channel::step && column(i).is_text;  // "run-in"
      if (!column(i).named || is_label || (rows && column(i).rows != *rows)) continue;
      const std::size_t rank = name_rank(labels_[i].base, channel, labels_[i].quantity);
      if (rank == no_rank || !is_free(i)) continue;
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
      result_.warnings.push_back(fmt::format("{} is read from column {}; {} could be it too (choose with {})",
                                             to_string(channel), column(*best).shown_name(), listed(rivals),
                                             setting("columns")));
    }
    return best;
  }

  /// Rows of their own have a clock of their own: each set of rows that holds a channel keeps its time column.
  void settle_clocks() {
    if (table_.rows.size() < 2) return;
    auto& time = of(Channel::time).column;
    std::set<std::size_t> sets;
    for (const Channel channel : all_channels) {
      if (channel != Channel::time && of(channel).column) sets.insert(column(*of(channel).column).rows);
    }
    if (time && !sets.empty() && !sets.contains(column(*time).rows)) time.reset();
    if (of(Channel::time).left_out() || (needs_no_time_ && !two_files_)) return;
    for (const std::size_t rows : sets) {
      if (time && column(*time).rows == rows) continue;
      if (const auto other = most_usual(Channel::time, rows)) other_times_.push_back(*other);
    }
  }

  /// Keeps the first present of several descriptions of one thing; what the user names comes before what is found.
  void choose_one(std::initializer_list<Channel> order) {
    const bool any_named = std::ranges::any_of(order, [&](Channel c) { return of(c).named(); });
    bool is_found = false;
    for (const Channel channel : order) {
      if (is_found || (any_named && !of(channel).named())) of(channel).column.reset();
      is_found = is_found || of(channel).column;
    }
  }

  void convert(Channel channel, std::size_t index) {
    Column used{channel, index, column(index).shown_name(), labels_[index].base};
    const auto of_column = units_of_columns_.find(index);
    const bool by_user = !of(channel).unit.empty() || of_column != units_of_columns_.end();
    const std::string& unit = !of(channel).unit.empty() ? of(channel).unit
                              : by_user                 ? of_column->second
                                                        : labels_[index].unit;
    used.plain = of(channel).plain;
    used.requested = of(channel).asked;
    if (find_conversion(used, unit, by_user)) result_.used.push_back(std::move(used));
  }

  /// Sets quantity, factor and offset. False when the channel can be done without and its unit is not known.
  bool find_conversion(Column& used, const std::string& text, bool by_user) {
    const auto quantities = info_of(used.channel).quantities;
    if (used.channel == Channel::step) return true;
    used.quantity = *quantities.begin();
    if (text.empty()) return without_unit(used);
    if (const auto sensitivity = find_sensitivity(text, used.channel)) {
      used.factor = *sensitivity;
      if (by_user) used.factor *= find_unit(labels_[used.index].unit, Quantity::voltage).value_or(Unit{}).factor;
      return true;
    }
    for (const Quantity quantity : quantities) {
      const auto unit = find_unit(text, quantity);
      if (!unit) continue;
      used.quantity = quantity;
      used.factor = unit->factor;
      used.offset = unit->offset;
      return true;
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
    const std::string key = key_of(used.channel), usual(info_of(used.channel).unit);
    InputLocation where = table_.heading(used.index);
    if (column(used.index).unit_line > 0) where.line = column(used.index).unit_line;  // apart from the name
    const std::string advice = "state the unit of " + key + " with " + setting("units", key + "=" + usual);
    const auto unit = find_unit(text);
    if (!unit) {
      const std::string nearest = suggest_unit(text);
      throw InputError(fmt::format("unknown unit '{}'", text),
                       (nearest.empty() ? "" : "did you mean " + nearest + "? otherwise ") + advice, where);
    }
    if (unit->quantity == Quantity::voltage) {
      const std::string sensitivity = key + "=\"5 " + usual + "/V\"";
      throw InputError("is in volts", "state the sensitivity with " + setting("units", sensitivity), where);
    }
    throw InputError(fmt::format("unit '{}' is {}, not {}", text, with_article(to_string(unit->quantity)),
                                 with_article(to_string(used.quantity))),
                     advice, where);
  }

  bool without_unit(Column& used) {
    const ChannelInfo& info = info_of(used.channel);
    if (info.unitless == Unitless::friction) used.factor = friction_factor();
    if (info.unitless == Unitless::si) {
      result_.notes.push_back(
          fmt::format("{} in column {} has no unit and was taken in {}", info.key, used.name, info.si_unit));
    }
    if (info.unitless != Unitless::unknown) return true;
    if (used.channel == Channel::speed && names_rpm(used.base)) {
      used.factor = kRpm;
      return true;
    }
    const bool is_machine = used.channel == Channel::x_d && names_load_point(used.base);
    const std::string unit(is_machine ? "um" : info.unit);
    const std::string advice = "state it with " + setting("units", key_of(used.channel) + "=" + unit);
    const bool needed = used.channel != Channel::angle &&
                        (used.channel != Channel::speed || !is_taken_of({Channel::v_b, Channel::v_r}));
    if (needed || of(used.channel).asked) throw InputError("has no unit", advice, table_.heading(used.index));
    result_.warnings.push_back(fmt::format("column {} has no unit and was not read; {}", used.name, advice));
    return false;
  }

  double friction_factor() const {
    for (const Channel channel : {Channel::mu, Channel::force, Channel::torque}) {
      if (const Column* column = result_.find(channel)) return column->factor;
    }
    return 1;
  }

  void note_unused() {
    std::vector<std::string> unused;
    for (std::size_t i = 0; i < table_.columns.size(); ++i) {
      const bool used = std::ranges::find(result_.used, i, &Column::index) != result_.used.end();
      if (!used && column(i).named) unused.push_back(column(i).shown_name());
    }
    if (!unused.empty()) result_.notes.push_back("columns not used: " + listed(unused));
  }

  const RawTable& table_;
  const ReadOptions& options_;
  const bool two_files_;  // a column may be in the other one
  const bool needs_no_time_;
  std::vector<Label> labels_;  // of the columns
  std::array<Wanted, channel_count> wanted_;
  std::map<std::size_t, std::string> units_of_columns_;  // that the user states by the name of the column
  std::vector<std::size_t> other_times_;
  Columns result_;
};

}  // namespace

const Column* Columns::find(Channel channel) const {
  const auto at = std::ranges::find(used, channel, &Column::channel);
  return at != used.end() ? &*at : nullptr;
}

bool Columns::has(Channel channel, Quantity quantity) const {
  const Column* column = find(channel);
  return column != nullptr && column->quantity == quantity;
}

Columns find_columns(const RawTable& table, const ReadOptions& options) {
  return Finder(table, options).find();
}

}  // namespace tribofit
