#include "altered_cases.hpp"

#include <fmt/format.h>

#include <utility>

// The list: what laboratories do to records, in several strengths, on rigs that take turns.

namespace tribofit::altered {
namespace {

struct Base {
  const char* name;
  double rpm, decay, noise, slower;
};

constexpr Base kBases[] = {{"4 rpm", 4, 52.14, 3e-3, 1},       {"2 rpm", 2, 52.14, 3e-3, 1},
                           {"8 rpm", 8, 35, 5e-3, 1},          {"12 rpm", 12, 52.14, 1e-3, 1},
                           {"4 rpm, S = 30", 4, 45, 3e-3, 30}, {"6 rpm, S = 0.05", 6, 52.14, 2e-3, 0.05}};

class List {
 public:
  explicit List(const AlteredOptions& all) : options(all) {}

  Alter low_pass(const std::vector<Channel>& channels, double corner) const {
    return butterworth(channels, 1, corner, options.filters.value_or(Discretisation::next_held));
  }
  Alter second_order(const std::vector<Channel>& channels, double corner) const {
    return butterworth(channels, 2, corner, options.filters.value_or(Discretisation::bilinear));
  }
  /// Twice: on the next two rigs.
  void add(const std::string& name, const Alter& apply, const std::vector<std::string>& may_name = {}) {
    for (int k = 0; k < 2; ++k) add_one(name, apply, may_name);
  }
  AlteredCase& add_one(const std::string& name, const Alter& apply, const std::vector<std::string>& may_name = {}) {
    const Base& base = kBases[next_++ % std::size(kBases)];
    AlteredCase one{fmt::format("{} ({})", name, base.name), group, {}, base.slower, apply, may_name, {}, {}};
    one.rig.rpm = base.rpm, one.rig.decay = base.decay, one.rig.friction_noise = base.noise;
    one.rig.duration = 10, one.rig.scatter = 0.004;
    one.rig.seed = 1000 * options.seed + 100 + static_cast<unsigned>(list.size());
    list.push_back(one);
    return list.back();
  }
  const AlteredOptions options;
  std::vector<AlteredCase> list;
  const char* group = "";  ///< of those that follow

 private:
  std::size_t next_ = 0;
};

struct Which {
  const char* name;
  std::vector<Channel> channels;
  std::vector<std::string> effects;
};

const std::vector<Which>& both_and_each() {
  static const std::vector<Which> all = {{"both", {kFriction, kVelocity}, {"force-bandwidth", "velocity-bandwidth"}},
                                         {"friction", {kFriction}, {"force-bandwidth"}},
                                         {"velocity", {kVelocity}, {"velocity-bandwidth"}}};
  return all;
}

/// A filter of one channel is a lag of that channel, and the more so the higher its order is.
std::vector<std::string> lag_too(const Which& which) {
  std::vector<std::string> effects = which.effects;
  if (which.channels.size() == 1) effects.emplace_back("channel-delay");
  return effects;
}

void add_filters(List& list) {
  for (const Which& which : both_and_each()) {
    for (const double corner : {100.0, 200.0, 300.0, 500.0, 1000.0, 2000.0, 3000.0})
      list.add_one(fmt::format("{}: low-pass of {} Hz", which.name, corner), list.low_pass(which.channels, corner),
                   which.effects);
    for (const double corner : {200.0, 500.0, 1000.0, 2000.0})
      list.add_one(fmt::format("{}: second order of {} Hz", which.name, corner),
                   list.second_order(which.channels, corner), which.effects);
    for (const double ms : {0.25, 0.5, 1.0, 2.0})
      list.add_one(fmt::format("{}: centred means of {} ms", which.name, ms), averaged(which.channels, 1e-3 * ms),
                   which.effects);
    for (const double ms : {0.5, 2.0})
      list.add_one(fmt::format("{}: means of the last {} ms", which.name, ms), trailing_mean(which.channels, 1e-3 * ms),
                   {"force-bandwidth", "velocity-bandwidth", "channel-delay"});
    for (const std::size_t count : {2U, 5U, 20U})
      list.add_one(fmt::format("{}: one in {} samples, repeated", which.name, count), held(which.channels, count),
                   {"force-bandwidth", "velocity-bandwidth", "channel-delay"});
    for (const double part : {0.3, 0.6, 0.9})
      list.add_one(fmt::format("{}: follows by {} of its steepest change", which.name, part),
                   slew_limited(which.channels, part), which.effects);
  }
  for (const auto& [friction, velocity] : {std::pair{200.0, 500.0}, {1000.0, 300.0}, {500.0, 2000.0}})
    list.add_one(fmt::format("friction: low-pass of {} Hz, velocity: of {} Hz", friction, velocity),
                 all_of({list.low_pass({kFriction}, friction), list.low_pass({kVelocity}, velocity)}),
                 {"force-bandwidth", "velocity-bandwidth"});
  for (const std::size_t count : {4U, 10U, 20U, 40U})
    list.add(fmt::format("averaged in blocks of {}", count), block_means(count));
  for (const double corner : {300.0, 1000.0}) {
    AlteredCase& one = list.add_one(fmt::format("velocity: low-pass of {} Hz, stated", corner),
                                    list.low_pass({kVelocity}, corner), {"velocity-bandwidth"});
    one.instruments.vibrometer.low_pass = Declared{corner / one.slower, 0};
  }
}

void add_limits(List& list) {
  for (const double limit : {0.5, 0.45, 0.4}) {
    for (const double dither : {0.0, 2e-4, 1e-3, 2e-3})
      list.add_one(fmt::format("friction: clipped at {}, dither {}", limit, dither), clipped_friction(limit, dither));
  }
  for (const double part : {0.5, 0.7, 0.9, 0.95}) {
    for (const double dither : {0.0, 5e-6, 5e-5})
      list.add_one(fmt::format("velocity: clipped at {}, dither {}", part, dither), clipped_velocity(part, dither));
  }
  for (const double step : {2e-4, 4e-4, 8e-4, 1e-3, 1.6e-3, 3.2e-3})
    list.add_one(fmt::format("velocity: steps of {} mm/s", 1e3 * step), rounded(kVelocity, step));
  for (const double step : {0.002, 0.004, 0.008, 0.02})
    list.add_one(fmt::format("friction: steps of {}", step), rounded(kFriction, step));
  const std::vector<std::string> compression = {"velocity-compression"};
  for (const double part : {0.03, 0.05, 0.1, 0.15, 0.2, 0.3, -0.1})
    list.add_one(fmt::format("velocity: gain falls by {} %", 100 * part), compressed(part), compression);
  for (const double part : {0.05, 0.1, 0.2})
    list.add_one(fmt::format("velocity: gain falls by {} %, with the speed", 100 * part), compressed_linearly(part),
                 {"velocity-compression", "velocity-gain", "radius-offset"});
  for (const double limit : {1.0, 1.5, 3.0})
    list.add_one(fmt::format("velocity: saturates at {} of the fastest", limit), saturated(limit), compression);
}

void add_levels_and_clocks(List& list) {
  for (const double zero : {1e-4, 2e-4, 5e-4, 1e-3, 2e-3, -2e-4, -1e-3})
    list.add_one(fmt::format("velocity: zero off by {} mm/s", 1e3 * zero), shifted(zero), {"velocity-offset"});
  for (const double factor : {0.9, 0.97, 1.05})
    list.add_one(fmt::format("velocity: gain {}", factor), gain(kVelocity, factor), {"radius-offset", "velocity-gain"});
  for (const double ppm : {20.0, 50.0, 100.0, -100.0, 200.0, -200.0, 500.0})
    list.add_one(fmt::format("clocks {} ppm apart", ppm), clocks_apart(ppm), {"clock-drift", "channel-delay"});
  for (const double ms : {0.1, 0.3, 1.0, 3.0, -0.5})
    list.add_one(fmt::format("friction {} ms late", ms), delayed(1e-3 * ms), {"channel-delay"});
  for (const double part : {0.01, 0.05, 0.2}) {
    for (const std::size_t length : {1U, 10U, 400U})
      list.add_one(fmt::format("{} % of samples lost, {} each", 100 * part, length), lost(part, length));
  }
  for (const double rpm : {2.0, 5.0, 8.0}) {
    AlteredCase& one = list.add_one(fmt::format("then at {} rpm", rpm), then_at(rpm));
    one.rig = {}, one.slower = 1;
    one.rig.seed += 1000 * list.options.seed;
    one.rig.duration = 10, one.rig.scatter = 0.004;
  }
  for (const double factor : {0.5, 1.05, 2.0, -1.0})
    list.add_one(fmt::format("v_r, gain {}", factor), relative(factor, 0), {"velocity-gain", "radius-offset"});
  for (const double zero : {2e-4, 1e-3, -3e-3})
    list.add_one(fmt::format("v_r, zero off by {} mm/s", 1e3 * zero), relative(1, zero), {"velocity-offset"});
}

void add_faults(List& list) {
  for (const auto& [name, channel] : {std::pair{"friction", kFriction}, {"velocity", kVelocity}}) {
    for (const double value : {-9999.0, 1e38, 9.9e37, 9999.0, -32768.0}) {
      for (const int count : {5, 100})
        list.add_one(fmt::format("{}: {} cells of {}", name, count, value), cells(channel, value, count));
    }
    for (const double size : {0.1, 0.3, 1.0})
      list.add_one(fmt::format("{}: lone spikes of {}", name, size),
                   spikes(channel, channel == kFriction ? size : 0.1 * size));
  }
  for (const Which& which : both_and_each()) {
    for (const double part : {0.02, 0.05, 0.1, 0.3})
      list.add_one(fmt::format("{}: frozen for {} %", which.name, 100 * part), frozen_for(which.channels, part));
    list.add(fmt::format("{}: a loose plug", which.name), loose(which.channels));
  }
  for (const auto& [from, to] : {std::pair{0.85, 1.0}, {0.6, 1.0}, {0.0, 0.15}, {0.0, 0.4}, {0.4, 0.55}, {0.2, 0.7}})
    list.add_one(fmt::format("machine stopped from {} to {}", from, to), stopped(from, to));
}

void add_loads(List& list) {
  for (const double part : {0.02, 0.05, 0.1, 0.2}) {
    for (const double period : {0.9, 2.3, 7.0, 15.0}) {
      AlteredCase& one =
          list.add_one(fmt::format("load swings by {} % in {} s", 100 * part, period), {}, {"load-dependence"});
      one.load = {part, period, 0};
    }
  }
  for (const double part : {0.03, 0.1, -0.1, 0.2}) {
    AlteredCase& one = list.add_one(fmt::format("load steps by {} %", 100 * part), {}, {"step", "load-dependence"});
    one.load = {0, 1, part};
  }
}

void add_other_recorders(List& list) {
  for (const Which& which : both_and_each()) {
    for (const double corner : {150.0, 400.0, 1500.0})
      list.add_one(fmt::format("{}: fourth order of {} Hz", which.name, corner),
                   all_of({list.second_order(which.channels, corner), list.second_order(which.channels, corner)}),
                   lag_too(which));
    for (const std::size_t half : {1U, 3U, 10U})
      list.add_one(fmt::format("{}: running median of {}", which.name, 2 * half + 1),
                   running_median(which.channels, half), which.effects);
    list.add_one(fmt::format("{}: low-pass of 60 Hz", which.name), list.low_pass(which.channels, 60), which.effects);
  }
  for (const double part : {1e-4, 1e-3, 1e-2})
    list.add(fmt::format("velocity: speckle lost over {} %", 100 * part), speckled(part));
  for (const double steps : {2.0, 3.0, 20.0})
    list.add_one(fmt::format("clock in steps of {}", steps), coarse_clock(steps));
  for (const double part : {0.3, 0.9}) list.add_one(fmt::format("clock jitters by {}", part), jittering_clock(part));
  for (const double by : {0.01, 0.05})
    list.add_one(fmt::format("friction: zero drifts by {}", by), drifting(kFriction, by), {"drift", "run-in"});
  for (const double by : {2e-4, 1e-3})
    list.add_one(fmt::format("velocity: zero drifts by {} mm/s", 1e3 * by), drifting(kVelocity, by),
                 {"velocity-offset"});
  list.add_one("friction: zero steps by 0.02", stepping(kFriction, 0.02), {"step"});
  list.add_one("velocity: zero steps by 0.3 mm/s", stepping(kVelocity, 3e-4), {"velocity-offset"});
  for (const double f : {50.0, 150.0})
    list.add_one(fmt::format("friction: hum of {} Hz", f), humming(kFriction, 0.006, f), {"interference"});
  list.add_one("velocity: hum of 50 Hz", humming(kVelocity, 2e-4, 50));
  for (const double step : {2.857, 10.0, 24.3}) list.add(fmt::format("resampled by {}", step), resampled(step));
  for (const std::size_t count : {4U, 20U})
    for (const auto& [name, channel] : {std::pair{"friction", kFriction}, {"velocity", kVelocity}})
      list.add_one(fmt::format("{}: drawn out over {} samples", name, count), drawn_out(channel, count));
}

void add_responses(List& list) {
  for (const double part : {0.03, 0.08, -0.05})
    list.add_one(fmt::format("velocity: gain {} % less against the disc", 100 * part), less_against_disc(part),
                 {"velocity-compression"});
  for (const double part : {0.02, 0.05, 0.1, 0.2})
    list.add_one(fmt::format("friction: gain falls by {} %", 100 * part), bent_friction(part),
                 {"friction-compression"});
}

}  // namespace

std::vector<AlteredCase> altered_cases(const AlteredOptions& options) {
  List list(options);
  constexpr std::pair<const char*, void (*)(List&)> kGroups[] = {{"filters, means and slew limits", add_filters},
                                                                 {"clipping, steps, gain that falls", add_limits},
                                                                 {"zero, gain and clock", add_levels_and_clocks},
                                                                 {"markers, spikes, frozen, stopped", add_faults},
                                                                 {"loads that nobody recorded", add_loads},
                                                                 {"other recorders", add_other_recorders},
                                                                 {"responses", add_responses}};
  for (const auto& [group, add] : kGroups) {
    list.group = group;
    add(list);
  }
  return list.list;
}

}  // namespace tribofit::altered
