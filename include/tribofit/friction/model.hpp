#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/friction/effects/all.hpp"
#include "tribofit/friction/law.hpp"

namespace tribofit {

/// A base law with any set of effects: the thing that is simulated, fitted and judged.
///
/// Its parameters are one flat array in SI: mu_s, mu_k, alpha or beta (none for coulomb), then those of each effect in
/// order.
class FrictionModel {
 public:
  /// Effects are put into the order of the catalogue, those that act in stick and the user's own last.
  /// Throws InputError when two effects are the same, or when they cannot act together (see acts_with).
  explicit FrictionModel(BaseLaw law, std::vector<Effect> effects = {});

  struct Slot {
    Parameter parameter;
    std::string effect;  ///< key; empty for the base law
    /// As the command line names it: "mu_s", "frictional-lag.tau".
    std::string full_name() const { return effect.empty() ? parameter.name : effect + "." + parameter.name; }
  };

  BaseLaw law() const { return law_; }
  std::span<const Effect> effects() const { return effects_; }
  std::span<const Slot> parameters() const { return slots_; }
  std::size_t base_count() const { return law_ == BaseLaw::coulomb ? 2 : 3; }
  /// First parameter of effect i.
  std::size_t offset(std::size_t i) const { return offsets_[i]; }
  /// First parameter of the effect of that key; the number of parameters where there is none.
  std::size_t offset_of(std::string_view key) const;
  std::vector<std::string> effect_keys() const;
  Channels needs() const;
  /// A bristle-like effect is among the effects: the block creeps in stick.
  bool acts_in_stick() const;
  /// Whether `effect` can be added: of what acts in stick, and of what counts the time at rest, there is one at most.
  bool acts_with(const Effect& effect) const;
  /// Number of memory states (one per effect with a memory).
  std::size_t state_count() const { return state_count_; }

  /// The effects as the command line takes them: "viscous", "rate-state:healing".
  std::vector<std::string> effect_names() const;

  /// "exponential + viscous + runout".
  std::string name() const;

  template <class T>
  LawParameters<T> base(const T* p) const {
    return {p[0], p[1], law_ == BaseLaw::coulomb ? T(0.0) : p[2]};
  }

 private:
  BaseLaw law_;
  std::vector<Effect> effects_;
  std::vector<Slot> slots_;
  std::vector<std::size_t> offsets_;
  std::size_t state_count_ = 0;
};

}  // namespace tribofit
