#include "tribofit/fit/rate_state.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "limits.hpp"
#include "rate_state_steps.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

namespace fit {
namespace {

constexpr std::array<std::string_view, 4> kDetrendNames = {"auto", "displacement", "time", "none"};

/// Slope of y over x by least squares, its error from the scatter about the line; NaN for fewer than three.
Estimate slope_of(const std::vector<double>& x, const std::vector<double>& y) {
  const StraightLine line = fit_line(x, y);
  if (x.size() < 3 || !(line.squares > 0)) return {std::nan(""), std::nan(""), 1};
  double left = 0;
  for (std::size_t i = 0; i < x.size(); ++i) left += std::pow(y[i] - line.at(x[i]), 2);
  const auto freedom = static_cast<double>(x.size() - 2);
  return {line.slope, std::sqrt(left / freedom / line.squares), freedom};
}

/// Mean of friction less the model over values [begin, end), with the error of white noise.
Estimate offset_over(const RateStateData& data, const Eigen::VectorXd& model, std::size_t begin, std::size_t end,
                     std::size_t first_row, std::size_t first_value, double noise) {
  double sum = 0, count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const auto row = static_cast<Eigen::Index>(first_row + i - first_value);
    sum += data.count[i] * (data.friction[i] - model(row));
    count += data.count[i];
  }
  return {sum / count, noise / std::sqrt(count), count};
}

/// Holds and how the peak behind them grows with the time at rest; nothing where there are none.
std::optional<Healing> healing_of(const RateStateData& data, const RateStateProblem& problem,
                                  const std::vector<double>& p, const RateStateFit& fit) {
  Eigen::VectorXd response;
  if (!problem.response(p.data(), response, nullptr)) return std::nullopt;
  Healing out;
  std::vector<double> decades, measured, simulated;
  for (std::size_t s = 0; s < data.steps.size(); ++s) {
    const VelocityStep& step = data.steps[s];
    if (!(step.hold > 0)) continue;
    const std::size_t begin = data.begins[s], end = data.end_of(s), row = problem.row_of(s);
    const auto at = [&](std::size_t i) { return response(static_cast<Eigen::Index>(row + i - begin)); };
    std::size_t stop = begin, go = begin, peak = begin, lowest = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (data.time[i] < step.time) stop = i + 1;
      if (data.time[i] < step.time + step.hold) go = i + 1;
    }
    if (go >= end || stop == begin) continue;
    peak = go;
    for (std::size_t i = go; i < end; ++i) {
      if (at(i) > at(peak)) peak = i;
    }
    lowest = go > stop ? go - 1 : stop;
    // Near the peak the model is right but for an offset, which noise says little of in one sample.
    const double near = 0.25 * std::abs(at(peak) - at(lowest));
    std::size_t from = peak, to = peak + 1;
    while (from > go && at(peak) - at(from - 1) < near) --from;
    while (to < end && at(peak) - at(to) < near) ++to;
    HoldMeasures hold;
    hold.step = s;
    hold.duration = step.hold;
    const double level = at(stop - 1);
    const Estimate before = offset_over(data, response, begin, stop, row, begin, fit.floor.noise),
                   behind = offset_over(data, response, from, to, row, begin, fit.floor.noise);
    hold.sliding = {level + before.value, before.std_error, before.degrees_of_freedom};
    hold.peak = {at(peak) + behind.value, behind.std_error, behind.degrees_of_freedom};
    hold.minimum = data.friction[lowest];
    hold.healing = hold.peak.value - hold.sliding.value;
    hold.relaxation = hold.sliding.value - hold.minimum;
    decades.push_back(std::log10(step.hold));
    measured.push_back(hold.healing);
    simulated.push_back(at(peak) - level);
    out.holds.push_back(hold);
  }
  if (out.holds.empty()) return std::nullopt;
  const auto [shortest, longest] = std::minmax_element(decades.begin(), decades.end());
  const bool differ = *longest - *shortest > kLeastDecades;
  out.per_decade = differ ? slope_of(decades, measured) : Estimate{std::nan(""), std::nan(""), 1};
  if (differ) out.per_decade_model = slope_of(decades, simulated).value;
  return out;
}

class Analysis {
 public:
  Analysis(const Motion& motion, const RateStateOptions& options) : motion_(motion), options_(options) {}

  RateStateAnalysis run() {
    const RateStateData data = rate_state_data(motion_, options_, kValuesOfStep, out_.messages);
    out_.reference_speed = data.reference_speed;
    out_.reference_source = options_.reference_speed > 0 ? "stated" : "the speed before the first step";
    out_.steps = data.steps;
    if (data.steps.empty()) {
      out_.reason =
          "there is no step of the load point's speed with enough samples around it: state the speeds with --speed "
          "0s:2um/s,60s:10um/s, or the column of the load point with --columns x_d=NAME or v_lp=NAME";
      return std::move(out_);
    }
    choose_states(data);
    out_.steps = chosen_.data.steps;
    out_.states = chosen_.model.states;
    out_.detrend = chosen_.model.detrend;
    out_.best = chosen_.best;
    out_.fits = chosen_.fits;
    out_.messages.insert(out_.messages.end(), chosen_.messages.begin(), chosen_.messages.end());
    if (!out_.fitted()) {
      out_.reason = out_.fits[out_.best].messages.empty() ? "no fit converged" : out_.fits[out_.best].messages.front();
      return std::move(out_);
    }
    for (std::size_t s = 0; s < out_.steps.size(); ++s)
      out_.steps[s].time_std_error = chosen_.best_fit().time_std_error[s];
    for (const std::size_t held : chosen_.at_limit) out_.steps[held].time_std_error = std::nan("");
    if (chosen_.at_limit.empty())
      out_.answer_p_value = p_value_of_no_answer(chosen_.problem(chosen_.best), best_minimum(), chosen_.best_fit());
    hold_out();
    compare_laws();
    if (options_.each_step && all().size() > 1) fit_each();
    out_.healing = healing_of(chosen_.data, chosen_.problem(chosen_.best), best_minimum().p, chosen_.best_fit());
    draw();
    return std::move(out_);
  }

 private:
  /// One state, unless a second describes the steps better beyond chance and what it adds, and a, are known from
  /// them.
  void choose_states(const RateStateData& data) {
    const auto with = [&](std::size_t states) {
      return fit_together(data, motion_.load_point_source, options_, states);
    };
    const bool names_second = std::any_of(options_.given.begin(), options_.given.end(),
                                          [](const GivenParameter& g) { return g.name == "b_2" || g.name == "D_c2"; });
    chosen_ = with(options_.states != 0 ? options_.states : names_second ? 2 : 1);
    if (options_.states != 0 || names_second) return;
    if (chosen_.best_fit().converged && !(chosen_.best_fit().noise_time > 0)) return;  // noise is all it leaves
    if (!chosen_.at_limit.empty()) {  // what steps at wrong times leave is no state
      out_.messages.emplace_back("a second state variable was not looked for, as times of steps are not known");
      return;
    }
    StepsTogether two = with(2);
    if (!two.best_fit().converged) return;
    if (chosen_.best_fit().converged) {
      out_.states_p_value = p_value_of_more(chosen_.problem(chosen_.best), best_minimum(), two.problem(two.best),
                                            two.minima[two.best], two.best_fit(), 2);
      out_.second_state = SecondState::not_needed;
      if (!(out_.states_p_value < kChanceOfSecondState)) return;
    }
    const std::vector<FitParameter>& found = two.best_fit().parameters;
    const auto is_vague = [](const FitParameter& p) { return !(p.std_error < kVagueOfState * std::abs(p.value)); };
    // a too: without it, a state that falls over less than a sample's sliding stands for the direct effect.
    if (std::any_of(found.begin(), found.end() - 1, is_vague)) {
      out_.second_state = SecondState::not_determined;
      if (chosen_.best_fit().converged)
        out_.messages.push_back(
            std::string("one state variable leaves more than noise, and these steps do not determine two: ") +
            (is_vague(found.front())
                 ? "a drive that turns faster, or more samples a second, would show the direct effect"
                 : "longer sliding behind each step would"));
      return;
    }
    out_.second_state = SecondState::found;
    chosen_ = std::move(two);
  }

  std::vector<std::size_t> all() const { return chosen_.all(); }
  const Solution& best_minimum() const { return chosen_.minima[chosen_.best]; }

  /// Each step in turn predicted by the fit of the others, its own constant and line aside.
  void hold_out() {
    const RateStateData& data = chosen_.data;
    if (all().size() < 2) return;
    for (std::size_t i = 0; i < chosen_.fits.size(); ++i) {
      if (!chosen_.fits[i].converged) continue;
      const RateStateModel model = chosen_.model_of(i);
      std::vector<double> squares(all().size()), counts(all().size());
      run_tasks(all().size(), options_.threads, [&](std::size_t s) {
        std::vector<std::size_t> others = all();
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(s));
        const Solution found = refine({data, model, others, 0}, chosen_.minima[i].p, chosen_.unknowns);
        const RateStateProblem held(data, model, {s}, 0);
        Eigen::VectorXd residual(static_cast<Eigen::Index>(held.count()));
        const bool valid = found.converged && held.evaluate(found.p.data(), residual.data(), nullptr);
        squares[s] = valid ? residual.squaredNorm() : std::nan("");
        for (std::size_t k = data.begins[s]; k < data.end_of(s); ++k) {
          counts[s] += data.count[k];
          squares[s] += data.scatter[k];
        }
      });
      const double count = std::accumulate(counts.begin(), counts.end(), 0.0);
      out_.fits[i].error.held_out_rmse = std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / count);
    }
  }

  /// Both laws have as many parameters. Were the other one true, the likelihood of the best would exceed its own by a
  /// factor of e^x with a probability of e^-x at most (Markov's inequality).
  void compare_laws() {
    if (chosen_.fits.size() != 2 || !out_.fits[0].converged || !out_.fits[1].converged) return;
    const std::size_t first = chosen_.best, second = 1 - first;
    const double below = log_likelihood_below(chosen_.problem(first), chosen_.minima[first], chosen_.problem(second),
                                              chosen_.minima[second], chosen_.fits[first]);
    if (std::isfinite(below)) out_.law_p_value = std::exp(-std::max(0.0, below));
  }

  void fit_each() {
    out_.each.resize(all().size());
    run_tasks(all().size(), options_.threads, [&](std::size_t s) {
      const RateStateModel model = chosen_.model_of(chosen_.best);
      RateStateUnknowns own = chosen_.unknowns;
      own.starts.insert(own.starts.begin(), best_minimum().p);
      out_.each[s] = fit_from(RateStateProblem(chosen_.data, model, {s}), own, search(chosen_.data, model, {s}, own));
      add_messages(out_.each[s]);
      out_.each[s].step = s;
    });
    compare_steps();
  }

  /// Whether a, b and D_c differ from step to step by more than their errors.
  void compare_steps() {
    const std::size_t n = 1 + 2 * chosen_.model.states, rows = n + 1;
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
    double squares = 0, freedom = std::numeric_limits<double>::infinity();
    std::size_t used = 0;
    for (const RateStateFit& fit : out_.each) {
      const bool known = fit.converged && std::none_of(fit.parameters.begin(), fit.parameters.end(),
                                                       [](const FitParameter& p) { return p.at_bound; });
      if (!known) continue;
      Eigen::MatrixXd covariance(n, n);
      Eigen::VectorXd value(n);
      for (std::size_t i = 0; i < n; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        value(row) = chosen_.unknowns.searched(i, fit.parameters[i].value);
        for (std::size_t j = 0; j < n; ++j)
          covariance(row, static_cast<Eigen::Index>(j)) = fit.covariance[i * rows + j];
      }
      const Eigen::MatrixXd weight = inverse_of_symmetric(covariance);
      weights += weight;
      sum += weight * value;
      squares += value.dot(weight * value);
      freedom = std::min(freedom, fit.degrees_of_freedom);
      ++used;
    }
    if (used < 2) return;
    const double rise = squares - sum.dot(solve_symmetric(weights, sum).col(0));
    const double compared = static_cast<double>((used - 1) * n);
    out_.sharing_p_value = f_p_value(std::max(0.0, rise) / compared, compared, std::min(freedom, kLargeFreedom));
  }

  void draw() {
    std::vector<Eigen::VectorXd> drawn;
    const RateStateData& data = chosen_.data;
    for (std::size_t i = 0; i < chosen_.fits.size(); ++i) {
      drawn.emplace_back();
      if (!chosen_.fits[i].converged) continue;
      Eigen::VectorXd residual(static_cast<Eigen::Index>(data.size()));
      if (chosen_.problem(i).evaluate(chosen_.minima[i].p.data(), residual.data(), nullptr)) drawn.back() = residual;
    }
    for (const std::size_t s : all()) {
      RateStateCurve curve;
      curve.step = s;
      for (std::size_t i = data.begins[s]; i < data.end_of(s); ++i) {
        const auto model = [&](std::size_t law) {
          return data.friction[i] + drawn[law](static_cast<Eigen::Index>(i)) / std::sqrt(data.count[i]);
        };
        curve.time.push_back(data.time[i]);
        curve.displacement.push_back(data.displacement[i]);
        curve.friction.push_back(data.friction[i]);
        curve.model.push_back(model(out_.best));
        if (chosen_.fits.size() == 2 && drawn[1 - out_.best].size() > 0) curve.other.push_back(model(1 - out_.best));
      }
      out_.curves.push_back(std::move(curve));
    }
  }

  const Motion& motion_;
  const RateStateOptions& options_;
  RateStateAnalysis out_;
  StepsTogether chosen_;
};

}  // namespace
}  // namespace fit

std::string_view to_string(Detrend detrend) {
  return fit::kDetrendNames.at(static_cast<std::size_t>(detrend));
}

std::vector<std::string> detrend_names() {
  return {fit::kDetrendNames.begin(), fit::kDetrendNames.end()};
}

std::optional<Detrend> find_detrend(std::string_view name) {
  const auto at = std::find(fit::kDetrendNames.begin(), fit::kDetrendNames.end(), name);
  if (at == fit::kDetrendNames.end()) return std::nullopt;
  return static_cast<Detrend>(at - fit::kDetrendNames.begin());
}

RateStateAnalysis fit_rate_state(const Motion& motion, const RateStateOptions& options) {
  return fit::Analysis(motion, options).run();
}

}  // namespace tribofit
