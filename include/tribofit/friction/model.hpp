#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/friction/effects/all.hpp"
#include "tribofit/friction/laws/all.hpp"

namespace tribofit {

/// Why `effect` cannot act on `law`; empty where it can.
std::string obstacle_on(const Law& law, const Effect& effect);

/// A base law with any set of effects: the thing that is simulated, fitted and judged.
///
/// Its parameters are one flat array in SI: those of the law, then those of each effect in order. A model of several
/// records together has the phases of an effect (periodic parameters of the scope `record`) once for each record: that
/// of the first record in its place, those of the others behind the effect's parameters.
class FrictionModel {
 public:
  /// Effects are put into the order of the catalogue, those that act in stick and the user's own last.
  /// Throws InputError when two effects are the same, or when they cannot act together or on this law (see acts_with).
  explicit FrictionModel(Law law, std::vector<Effect> effects = {}, std::size_t records = 1);

  struct Slot {
    Parameter parameter;
    std::string effect;  ///< key; empty for the base law
    /// As the command line names it: "mu_s", "frictional-lag.tau", "runout.phase[2]" in the second of several records.
    std::string full_name() const { return effect.empty() ? parameter.name : effect + "." + parameter.name; }
  };

  const Law& law() const { return law_; }
  std::span<const Effect> effects() const { return effects_; }
  std::span<const Slot> parameters() const { return slots_; }
  /// Parameters of the law, which come first.
  std::size_t base_count() const { return base_count_; }
  /// First parameter of effect i.
  std::size_t offset(std::size_t i) const { return offsets_[i]; }
  /// First parameter of the effect of that key; the number of parameters where there is none.
  std::size_t offset_of(std::string_view key) const;
  /// Parameters of effect i, those of further records among them.
  std::size_t count(std::size_t i) const {
    return (i + 1 < offsets_.size() ? offsets_[i + 1] : slots_.size()) - offsets_[i];
  }
  /// The same of the effect of that key; 0 where there is none.
  std::size_t count_of(std::string_view key) const;
  /// Records that the model is of.
  std::size_t records() const { return records_; }
  /// The same law and effects for a record by itself.
  FrictionModel of_one_record() const { return FrictionModel(law_, effects_); }
  /// Parameters in which those of `record` stand in the place of the first record's; where has_values_of(record).
  template <class T>
  std::vector<T> values_of(std::size_t record, const T* p) const {
    std::vector<T> out(p, p + slots_.size());
    for (const Own& own : own_) out[own.first] = p[own.further + record - 1];
    return out;
  }
  /// Record r, counted from 0, has values of its own beside those of the first.
  bool has_values_of(std::size_t record) const { return record > 0 && record < records_ && !own_.empty(); }
  /// Slot k holds the value of a further record.
  bool is_of_further_record(std::size_t k) const;
  /// Where the parameter of slot k of the first record stands for record r; k itself where all records share it.
  std::size_t slot_of(std::size_t k, std::size_t record) const;
  std::vector<std::string> effect_keys() const;
  Channels needs() const;
  /// A bristle-like effect is among the effects: the block creeps in stick.
  bool acts_in_stick() const;
  /// Whether `effect` can be added: of what acts in stick, and of what counts the time at rest, there is one at most; a
  /// law without a reduced speed has none that could be changed.
  bool acts_with(const Effect& effect) const;
  /// Number of memory states (one per effect with a memory).
  std::size_t state_count() const { return state_count_; }

  /// The effects as the command line takes them: "viscous", "rate-state:healing".
  std::vector<std::string> effect_names() const;

  /// "exponential + viscous + runout".
  std::string name() const;

  template <class T>
  LawValues<T> law_values(const T* p) const {
    LawValues<T> values;
    for (std::size_t k = 0; k < base_count_; ++k) values.q[k] = p[k];
    values.scaled = scaled_;
    return values;
  }

 private:
  Law law_;
  std::vector<Effect> effects_;
  std::vector<Slot> slots_;
  std::vector<std::size_t> offsets_;
  struct Own {
    std::size_t first = 0, further = 0;  ///< slots of the first record and of the second
  };
  std::vector<Own> own_;
  std::size_t records_ = 1;
  std::size_t base_count_ = 0, state_count_ = 0;
  std::uint32_t scaled_ = 0;  // bit k: parameter k of the law scales with friction
};

}  // namespace tribofit
