#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "limits.hpp"
#include "recording.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {
namespace {

/// Throws InputError where a stress stands over a force or the other way round, which is no coefficient, and for a
/// shear stress alone.
void refuse_stress_beside_force(const FileRecord& run) {
  const bool stress = run.is_stress(Channel::force), load = run.has(Channel::load);
  if (load && stress != run.is_stress(Channel::load)) {
    throw InputError(
        stress ? "friction is a shear stress and the load a force" : "friction is a force and the load a normal stress",
        "give both as stresses or both as forces; " + setting("units") + " states them (force=MPa,load=MPa)",
        run.file());
  }
  if (!stress || load) return;
  throw InputError("the shear stress needs the normal stress, which is not known",
                   "name its column with " + setting("columns", "load=NAME:MPa") + ", or name the column of mu",
                   run.file());
}

class Assembler {
 public:
  Assembler(FileRecord run, const ReadOptions& options, bool* needs_radius)
      : run_(std::move(run)), options_(options), needs_radius_(needs_radius) {}

  Trace assemble() {
    set_kind();
    leave_out_unloaded_ends(run_);
    set_steps();
    set_lever();
    set_load();
    set_friction();
    warn_of_large_coefficient();
    set_velocity();
    settle_speed();
    if (trace_.normal_stress.known()) trace_.load.clear();
    unwrap(trace_.disc_angle);
    if (run_.is_points()) sort_points(trace_);
    if (trace_.disc_angle.empty() && trace_.disc_speed.empty()) set_angle_turned();
    return std::move(static_cast<Trace&>(run_));
  }

 private:
  void set_kind() {
    const bool spring_alone = run_.has(Channel::spring) && !run_.has(Channel::mu) && !run_.has(Channel::force);
    if (!run_.kind && spring_alone) {
      run_.kind = RecordKind::spring_slider;
      run_.kind_source = "the pull of a spring was recorded";
    }
    settle_kind_without_friction();
    trace_.spring = options_.spring;
    if (run_.has(Channel::std_error) && !run_.is_points()) {
      trace_.notes.emplace_back("standard errors of friction are used for points only");
      trace_.friction_std_error.clear();
    }
  }

  /// The motion alone, or friction alone, where nothing else of the file could be the other.
  void settle_kind_without_friction() {
    const bool stiffness_alone = run_.kind == RecordKind::spring_slider;  // which a stiffness says of both
    if (run_.has(Channel::x_b) && !run_.has_friction() && (!run_.kind || stiffness_alone)) {
      run_.kind = RecordKind::motion_only;
      run_.kind_source = "no friction was recorded";
    }
    if (!run_.has(Channel::x_b) && !run_.is_driven() && run_.has(Channel::speed))
      run_[Channel::x_d].clear();  // a stage is not the disc
    const bool moves = run_.has_velocity() || run_.has_position() || run_.has(Channel::speed);
    const bool all_used = run_.second_path.empty() && run_.columns.used.size() == run_.column_names.size();
    if (!run_.kind && run_.has_friction() && !moves && all_used && !options_.conditions.speed.known()) {
      run_.kind = RecordKind::force_only;
      run_.kind_source = "no motion was recorded";
    }
  }

  void set_steps() {
    const auto& radii = options_.step_radii;
    refuse_other_count(radii.size());
    if (options_.conditions.radius.known()) refuse_radius(options_.conditions.radius.value);
    for (auto& [begin, end, label, conditions, recipe] : trace_.steps) {
      conditions = first_known(options_.conditions, conditions);
      if (!radii.empty()) conditions.radius = {radii[recipe], "command line"};
      if (conditions.radius.known()) refuse_radius(conditions.radius.value);
    }
    for (const ConditionInfo& info : condition_infos) trace_.conditions.*info.member = common(info.member);
    if (radii.empty() && run_.recipe_size() > 1 && options_.conditions.radius.known()) {
      trace_.notes.push_back(fmt::format("the radius of {} mm was taken for all {} steps",
                                         general(1e3 * trace_.conditions.radius.value), run_.recipe_size()));
    }
  }

  void refuse_other_count(std::size_t radii) const {
    if (radii == 0 || radii == run_.recipe_size()) return;
    std::vector<std::string> labels;
    for (const Step& step : trace_.steps) labels.push_back(step.label);
    throw InputError(fmt::format("the file has {} step{} ({}) but {} radii were given", run_.recipe_size(),
                                 run_.recipe_size() == 1 ? "" : "s", listed(labels), radii),
                     "give one radius for each step, in their order", run_.file());
  }

  void refuse_radius(double radius) const {
    if (radius > kSmallestRadius && std::isfinite(radius)) return;
    throw InputError(fmt::format("a friction radius of {} mm is not possible", general(1e3 * radius)),
                     "give a radius above zero", run_.file());
  }

  /// The condition that all steps share; not known where they differ.
  Condition common(Condition Conditions::*condition) const {
    const Condition& first = trace_.steps.front().conditions.*condition;
    const bool same = std::all_of(trace_.steps.begin(), trace_.steps.end(),
                                  [&](const Step& step) { return (step.conditions.*condition).value == first.value; });
    return same ? first : Condition{};
  }

  double radius_of(const Step& step, const char* why) const {
    if (step.conditions.radius.known()) return step.conditions.radius.value;
    if (needs_radius_ != nullptr) {
      *needs_radius_ = true;
      return 0.015;
    }
    std::string advice = "give it with " + setting("radius", "15mm");
    if (run_.recipe_size() > 1)
      advice += fmt::format(", or one for each of the {} steps where it changes", run_.recipe_size());
    throw InputError(std::string(why) + " needs the friction radius, which is not known", advice, run_.file());
  }

  bool is_angular(Channel velocity) const { return run_.columns.has(velocity, Quantity::angular_velocity); }

  /// A joint has no radius: torque and rotational speed are those at a lever of 1 m. Over a load that would be no mu.
  void set_lever() {
    const bool unknown = std::none_of(trace_.steps.begin(), trace_.steps.end(),
                                      [](const Step& step) { return step.conditions.radius.known(); });
    const bool torque = run_.has(Channel::torque) && !run_.has(Channel::mu) && !run_.has(Channel::force);
    const Channel velocity = run_.has(Channel::v_b) ? Channel::v_b : Channel::v_r;
    const bool steady = run_.is_points() || run_.kind == RecordKind::sliding;
    const bool turns = run_.columns.find(velocity) != nullptr
                           ? is_angular(velocity) && (steady || velocity == Channel::v_r)
                           : steady && run_.has(Channel::speed);
    const bool loaded = run_.has(Channel::load) || trace_.conditions.load.known();
    if (!unknown || !torque || !turns || (loaded && !steady)) return;
    trace_.conditions.radius = {1, "lever of 1 m"};
    for (Step& step : trace_.steps) step.conditions.radius = trace_.conditions.radius;
    trace_.notes.emplace_back(
        "no radius is known: torque and rotational speed are taken at a lever of 1 m, so that N stands for N m, mm/s "
        "for mrad/s and s/mm for s/mrad");
  }

  void set_load() {
    auto& load = run_[Channel::load];
    if (load.empty()) return;
    if (std::all_of(load.begin(), load.end(), [](double value) { return value < 0; })) {
      for (double& value : load) value = -value;
      trace_.notes.push_back("the load is negative throughout and was taken as compression");
    }
    const double mean = mean_load(load, {0, load.size(), "", {}}).value;
    if (run_.is_stress(Channel::load)) {
      trace_.normal_stress = {mean, "file"};
    } else if (!trace_.conditions.load.known()) {
      trace_.conditions.load = {mean, "file"};
      for (Step& step : trace_.steps) {
        if (!step.conditions.load.known()) step.conditions.load = mean_load(load, step);
      }
    } else if (std::abs(mean / trace_.conditions.load.value - 1) > kLoadKnownTo) {
      trace_.warnings.push_back(fmt::format("the stated load of {} N contradicts the mean of the load channel, {} N",
                                            general(trace_.conditions.load.value), general(mean, 4)));
    }
  }

  static Condition mean_load(const std::vector<double>& load, const Step& step) {
    double sum = 0;
    for (std::size_t i = step.begin; i < step.end; ++i) sum += load[i];
    return {sum / static_cast<double>(step.end - step.begin), "file"};
  }

  void set_std_error() {
    for (std::size_t i = 0; i < trace_.friction_std_error.size(); ++i) {
      if (trace_.friction_std_error[i] > 0) continue;
      throw InputError("a standard error must be above zero",
                       "correct it, or leave the column out with " + setting("columns", "std_error=none"),
                       run_.location(i, Channel::std_error));
    }
  }

  void divide_friction(std::size_t i, double by) {
    trace_.friction[i] /= by;
    if (!trace_.friction_std_error.empty()) trace_.friction_std_error[i] /= by;
  }

  void set_friction() {
    if (run_.is_points()) set_std_error();
    if (run_.kind == RecordKind::motion_only) {  // follows from the motion, kinematics/ makes it
      if (!run_.has(Channel::x_b)) refuse_columns(run_, "no displacement column (x_b)");
      trace_.friction.clear();
      return;
    }
    if (run_.has(Channel::spring) && run_.kind == RecordKind::spring_slider) {
      if (!run_.columns.has(Channel::spring, Quantity::dimensionless)) divide_by_load("pull of the spring");
      return;
    }
    if (run_.has(Channel::mu)) return;
    const bool torque = run_.has(Channel::torque);
    if (!torque && !run_.has(Channel::force)) refuse_columns(run_, "no friction column (mu, force or torque)");
    if (!torque) refuse_stress_beside_force(run_);
    if (torque) {
      for (const Step& step : trace_.steps) {
        const double radius = radius_of(step, "friction from a torque");
        for (std::size_t i = step.begin; i < step.end; ++i) divide_friction(i, radius);
      }
    }
    divide_by_load(torque ? "torque/radius" : run_.is_stress(Channel::force) ? "shear stress" : "tangential force");
  }

  void divide_by_load(const std::string& force) {
    if (!run_[Channel::load].empty()) return divide_by_measured_load(force);
    if (std::ranges::any_of(trace_.steps, [](const Step& s) { return !s.conditions.load.known(); })) {
      trace_.friction_kind = FrictionKind::force;
      trace_.notes.push_back("no normal force is known: friction is a force in N, " + force +
                             (force == "torque/radius" ? "" : " as measured") + " (state " + setting("load") +
                             " for a coefficient)");
      return;
    }
    for (const Step& step : trace_.steps) {
      const double nominal = step.conditions.load.value;
      if (!(nominal > 0))
        throw InputError("the load must be above zero", "give it as " + setting("load", "50N"), run_.file());
      for (std::size_t i = step.begin; i < step.end; ++i) divide_friction(i, nominal);
    }
    const Condition& load = trace_.conditions.load;
    trace_.notes.push_back("mu is " + force + " over the nominal load of " +
                           (load.known() ? fmt::format("{} N", general(load.value)) : std::string("each step")));
  }

  void divide_by_measured_load(const std::string& force) {
    const auto& load = run_[Channel::load];
    for (std::size_t i = 0; i < load.size(); ++i) {
      if (!(load[i] > kSmallestLoad)) {
        throw InputError(fmt::format("the load is {} N, and friction is {} over load", general(load[i]), force),
                         "remove the rows without load, or leave the channel out with " +
                             setting("columns", "load=none") + " and state " + setting("load"),
                         run_.location(i, Channel::load));
      }
      divide_friction(i, load[i]);
    }
    trace_.notes.push_back("mu is " + force + " over the measured " +
                           (trace_.normal_stress.known() ? "normal stress" : "load"));
  }

  void warn_of_large_coefficient() {
    if (trace_.friction_kind != FrictionKind::coefficient || trace_.friction.empty()) return;
    const Extremes friction = extremes(trace_.friction);
    const double largest = std::max(-friction.low, friction.high);
    if (largest <= kLargestCoefficient) return;
    trace_.warnings.push_back(
        fmt::format("friction reaches {}: is the column really a coefficient?", general(largest, 4)));
  }

  /// What the user states beats the column: a column that contradicts it is not used.
  void settle_speed() {
    auto& column = run_[Channel::speed];
    const Condition& stated = options_.conditions.speed;
    if (column.empty() || !stated.known()) return;
    const double usual = median(column);
    if (std::abs(usual - stated.value) <= kSpeedKnownTo * std::abs(stated.value)) return;
    trace_.warnings.push_back(fmt::format(
        "the stated speed of {} rpm ({}) contradicts the median of the speed column, {} rpm; the "
        "stated speed is used and the column is not",
        general(stated.value / kRpm, 4), stated.source.empty() ? "stated" : stated.source, general(usual / kRpm, 4)));
    column.clear();
  }

  void set_velocity() {
    const bool block = run_.has(Channel::v_b), relative = run_.has(Channel::v_r);
    const bool is_spring_slider = run_.kind == RecordKind::spring_slider,
               is_motion_only = run_.kind == RecordKind::motion_only;
    trace_.velocity_kind = VelocityKind::relative;
    if (is_spring_slider || run_.kind == RecordKind::force_only)  // follows from the pull, or not at all
      return keep_motion({});
    if (run_.is_driven()) return set_load_point();
    if (is_motion_only || (run_.has_position() && !block && !relative)) {  // kinematics/ makes it of the displacement
      if (!is_motion_only && !run_.has(Channel::x_d)) trace_.velocity_kind = VelocityKind::block;
      return keep_motion({&Trace::block_position, &Trace::drive_position});
    }
    keep_motion({&Trace::velocity});
    if (!block && !relative) return set_fixed_block();
    trace_.velocity_kind = block && !run_.is_points() ? VelocityKind::block : VelocityKind::relative;
    const Channel channel = block ? Channel::v_b : Channel::v_r;
    if (!is_angular(channel)) return;
    if (!block && !run_.is_points() && !options_.conditions.speed.known()) turning_ = trace_.velocity;
    for (const Step& step : trace_.steps) {
      const double radius = radius_of(step, "a velocity given as a rotational speed");
      for (std::size_t i = step.begin; i < step.end; ++i) trace_.velocity[i] *= radius;
    }
    trace_.notes.push_back(fmt::format("{} is the rotational speed in column {} times the radius", to_string(channel),
                                       run_.columns.find(channel)->name));
  }

  using Values = std::vector<double> Trace::*;
  /// Clears what else there is of motion.
  void keep_motion(std::initializer_list<Values> kept) {
    for (const Values values :
         {&Trace::velocity, &Trace::block_position, &Trace::drive_position, &Trace::load_point_speed}) {
      if (std::find(kept.begin(), kept.end(), values) == kept.end()) (trace_.*values).clear();
    }
  }

  /// How the load point moved: as stated, else its speed, else its displacement.
  void set_load_point() {
    trace_.load_point = options_.load_point;
    if (!trace_.load_point.empty()) return keep_motion({});
    if (!trace_.drive_position.empty()) return keep_motion({&Trace::drive_position});
    keep_motion({&Trace::load_point_speed});
    if (!trace_.load_point_speed.empty()) return;
    refuse_columns(run_, "no displacement (x_d) or speed (v_lp) of the load point");
  }

  /// One part turns against the other: the angle between them is the integral of the rotational speed recorded.
  void set_angle_turned() {
    if (turning_.empty()) return;
    trace_.disc_angle.assign(turning_.size(), 0.0);
    for (std::size_t i = 1; i < turning_.size(); ++i) {
      const double mean = 0.5 * (turning_[i - 1] + turning_[i]);
      trace_.disc_angle[i] = trace_.disc_angle[i - 1] + mean * (trace_.time[i] - trace_.time[i - 1]);
    }
  }

  /// Points of a block that stands still on a disc.
  void set_points_over_disc() {
    trace_.velocity_kind = VelocityKind::relative;
    trace_.velocity = std::move(trace_.disc_speed);
    const double radius = radius_of(trace_.steps.front(), "the sliding velocity of a fixed block");
    for (double& v : trace_.velocity) v *= radius;
    trace_.notes.emplace_back("no sliding velocity: the block is taken as fixed, v_r = omega r");
  }

  void set_fixed_block() {
    if (run_.is_points() && run_.has(Channel::speed)) return set_points_over_disc();
    const auto said = [&](const char* channel) {
      const auto at = options_.columns.find(channel);
      return at != options_.columns.end() && (at->second.empty() || at->second == "none");
    };
    const bool constant_speed = said("v_b") && options_.conditions.speed.known();
    if (!run_.has(Channel::speed) && !constant_speed) {
      refuse_columns(run_, "no velocity column (v_b, v_r, x_b, or the disc's speed for a fixed block)");
    }
    trace_.velocity_kind = VelocityKind::fixed_block;
    for (const Step& step : trace_.steps) radius_of(step, "the sliding velocity of a fixed block");
    trace_.notes.push_back("no block velocity: the block is taken as fixed, v_r = omega r");
  }

  /// An angle that stays within one turn and jumps back wraps; others count on.
  static void unwrap(std::vector<double>& angle) {
    constexpr double turn = 2 * std::numbers::pi;
    const auto [low, high] = angle.empty() ? Extremes{} : extremes(angle);
    if (angle.empty() || high - low > kOneTurn * turn) return;
    double turns = 0, last = angle.front();
    for (double& value : angle) {
      if (value - last > turn / 2) turns -= turn;
      if (last - value > turn / 2) turns += turn;
      last = value;
      value += turns;
    }
  }

  FileRecord run_;
  const ReadOptions& options_;
  bool* needs_radius_;
  Trace& trace_ = run_;
  std::vector<double> turning_;  ///< rotational speed between the parts [rad/s], where it is all that was recorded
};

}  // namespace

Conditions first_known(const Conditions& first, const Conditions& second) {
  Conditions known = first;
  for (const auto& info : condition_infos) {
    if (!(first.*info.member).known()) known.*info.member = second.*info.member;
  }
  return known;
}

Trace assemble(FileRecord run, const ReadOptions& options, bool* needs_radius) {
  return Assembler(std::move(run), options, needs_radius).assemble();
}

}  // namespace tribofit
