#include "tribofit/fit/rate_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "limits.hpp"
#include "rate_state_errors.hpp"
#include "rate_state_holds.hpp"
#include "rate_state_times.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/parallel.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace fit {
namespace {

constexpr std::array<std::string_view, 4> kDetrendNames = {"auto", "displacement", "time", "none"};

/// Everything that one law leaves of the steps together.
struct LawFit {
  StateEvolution evolution = StateEvolution::ageing;
  RateStateSolution solution;
  RateStateFit fit;
};

class Analysis {
 public:
  Analysis(const Motion& motion, const RateStateOptions& options)
      : motion_(motion), options_(options), data_(rate_state_data(motion, options, kValuesOfStep, out_.messages)) {}

  RateStateAnalysis run() {
    out_.reference_speed = data_.reference_speed;
    out_.reference_source = options_.reference_speed > 0 ? "stated" : "the speed before the first step";
    out_.steps = data_.steps;
    if (data_.steps.empty()) {
      out_.reason =
          "there is no step of the load point's speed with enough samples around it: state the speeds with --speed "
          "0s:2um/s,60s:10um/s, or the column of the load point with --columns x_d=NAME or v_lp=NAME";
      return std::move(out_);
    }
    unknowns_ = unknowns_of(data_, options_.states, options_.given);
    all_.resize(data_.steps.size());
    std::iota(all_.begin(), all_.end(), std::size_t{0});
    choose_detrend();
    settle_times();
    fit_laws();
    if (!out_.fitted()) {
      out_.reason = out_.fits[out_.best].messages.empty() ? "no fit converged" : out_.fits[out_.best].messages.front();
      return std::move(out_);
    }
    hold_out();
    compare_laws();
    if (options_.each_step && all_.size() > 1) fit_each();
    out_.healing = healing_of(data_, problem(best().evolution), best().solution.p, best().fit);
    draw();
    return std::move(out_);
  }

 private:
  RateStateProblem problem(StateEvolution evolution) const {
    return {data_, evolution, options_.states, out_.detrend, all_};
  }
  const LawFit& best() const { return laws_[out_.best]; }

  RateStateSolution searched(StateEvolution evolution, Detrend detrend) const {
    return search_together(data_, evolution, options_.states, detrend, all_, unknowns_);
  }

  /// The line is one over what leaves less; over the displacement where both leave the same. The law is not known yet:
  /// one that is wrong would choose the line that hides most of its own error.
  void choose_detrend() {
    out_.detrend = options_.detrend;
    if (options_.detrend != Detrend::automatic) return;
    const std::array<Detrend, 2> both = {Detrend::displacement, Detrend::time};
    const std::size_t laws = options_.evolutions.size();
    std::vector<double> cost(both.size() * laws, std::numeric_limits<double>::infinity());
    std::vector<RateStateSolution> found(cost.size());
    run_tasks(cost.size(), options_.threads, [&](std::size_t i) {
      found[i] = searched(options_.evolutions[i % laws], both[i / laws]);
      if (found[i].found) cost[i] = found[i].cost;
    });
    const auto middle = cost.begin() + static_cast<std::ptrdiff_t>(laws);
    const std::array<double, 2> least = {*std::min_element(cost.begin(), middle),
                                         *std::min_element(middle, cost.end())};
    const std::size_t chosen = least[1] < least[0] ? 1 : 0;
    out_.detrend = both[chosen];
    const auto first = found.begin() + static_cast<std::ptrdiff_t>(chosen * laws);
    searched_.assign(first, first + static_cast<std::ptrdiff_t>(laws));
  }

  /// Steps whose times are known to a sample or a second are moved to where the response fits best.
  void settle_times() {
    const bool known =
        std::all_of(data_.steps.begin(), data_.steps.end(), [](const VelocityStep& step) { return step.slack == 0; });
    if (known) return;
    RateStateSolution least;
    StateEvolution law = options_.evolutions.front();
    for (std::size_t i = 0; i < options_.evolutions.size(); ++i) {
      const StateEvolution evolution = options_.evolutions[i];
      const RateStateSolution found = searched_.empty() ? searched(evolution, out_.detrend) : searched_[i];
      if (!found.found || (least.found && !(found.cost < least.cost))) continue;
      least = found;
      law = evolution;
    }
    searched_.clear();
    const double moved = refine_step_times(data_, law, options_.states, out_.detrend, unknowns_, least);
    out_.steps = data_.steps;
    if (moved > data_.steps.front().interval) {
      const bool stated = motion_.load_point_source == LoadPointSource::stated;
      out_.messages.push_back(fmt::format(
          "steps were moved by up to {:.3g} s to where the response fits best: their "
          "times are known to {}",
          moved, stated ? "a tenth of the sliding beside them, as stated" : "a sample of the recorded speed"));
    }
  }

  void fit_laws() {
    laws_.resize(options_.evolutions.size());
    run_tasks(laws_.size(), options_.threads, [&](std::size_t i) {
      laws_[i].evolution = options_.evolutions[i];
      laws_[i].solution = searched_.empty() ? searched(laws_[i].evolution, out_.detrend) : searched_[i];
      laws_[i].fit = fit_from(problem(laws_[i].evolution), data_, unknowns_, laws_[i].solution, laws_[i].evolution,
                              options_.states);
      add_messages(laws_[i].fit);
    });
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < laws_.size(); ++i) {
      out_.fits.push_back(laws_[i].fit);
      if (!laws_[i].fit.converged || !(laws_[i].solution.cost < least)) continue;
      least = laws_[i].solution.cost;
      out_.best = i;
    }
  }

  /// Each step in turn predicted by the fit of the others, its own constant and line aside.
  void hold_out() {
    if (all_.size() < 2) return;
    for (std::size_t i = 0; i < laws_.size(); ++i) {
      if (!laws_[i].fit.converged) continue;
      std::vector<double> squares(all_.size()), counts(all_.size());
      run_tasks(all_.size(), options_.threads, [&](std::size_t s) {
        std::vector<std::size_t> others = all_;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(s));
        const RateStateProblem rest(data_, laws_[i].evolution, options_.states, out_.detrend, others, all_.front());
        const RateStateSolution found = refine(rest, laws_[i].solution.p, unknowns_);
        const RateStateProblem held(data_, laws_[i].evolution, options_.states, out_.detrend, {s}, all_.front());
        std::vector<double> residual(held.count());
        const bool valid = found.found && held.evaluate(found.p.data(), residual.data(), nullptr);
        squares[s] = valid ? std::inner_product(residual.begin(), residual.end(), residual.begin(), 0.0) : std::nan("");
        for (std::size_t k = data_.begins[s]; k < data_.end_of(s); ++k) counts[s] += data_.count[k];
      });
      const double count = std::accumulate(counts.begin(), counts.end(), 0.0);
      out_.fits[i].held_out_rmse = std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / count);
    }
  }

  /// Both laws have as many parameters. Were the other one true, the likelihood of the best would exceed its own by a
  /// factor of e^x with a probability of e^-x at most (Markov's inequality).
  void compare_laws() {
    if (laws_.size() != 2 || !laws_[0].fit.converged || !laws_[1].fit.converged) return;
    const LawFit &first = best(), &second = laws_[1 - out_.best];
    const double below = log_likelihood_below(problem(first.evolution), first.solution, problem(second.evolution),
                                              second.solution, data_, first.fit);
    if (std::isfinite(below)) out_.law_p_value = std::exp(-std::max(0.0, below));
  }

  void fit_each() {
    out_.each.resize(all_.size());
    run_tasks(all_.size(), options_.threads, [&](std::size_t s) {
      RateStateUnknowns own = unknowns_;
      own.starts.insert(own.starts.begin(), best().solution.p);
      const std::vector<std::size_t> alone = {s};
      const RateStateProblem part(data_, best().evolution, options_.states, out_.detrend, alone);
      const RateStateSolution found = search(data_, best().evolution, options_.states, out_.detrend, alone, own);
      out_.each[s] = fit_from(part, data_, own, found, best().evolution, options_.states);
      add_messages(out_.each[s]);
      out_.each[s].step = s;
    });
    compare_steps();
  }

  /// Whether a, b and D_c differ from step to step by more than their errors.
  void compare_steps() {
    const std::size_t n = 1 + 2 * options_.states, all = n + 1;
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
        value(row) = unknowns_.searched(i, fit.parameters[i].value);
        for (std::size_t j = 0; j < n; ++j) covariance(row, static_cast<Eigen::Index>(j)) = fit.covariance[i * all + j];
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
    for (const LawFit& law : laws_) {
      drawn.emplace_back();
      if (law.fit.converged) {
        Eigen::VectorXd residual(static_cast<Eigen::Index>(data_.size()));
        if (problem(law.evolution).evaluate(law.solution.p.data(), residual.data(), nullptr)) drawn.back() = residual;
      }
    }
    for (const std::size_t s : all_) {
      RateStateCurve curve;
      curve.step = s;
      for (std::size_t i = data_.begins[s]; i < data_.end_of(s); ++i) {
        const auto model = [&](std::size_t law) {
          return data_.friction[i] + drawn[law](static_cast<Eigen::Index>(i)) / std::sqrt(data_.count[i]);
        };
        curve.time.push_back(data_.time[i]);
        curve.displacement.push_back(data_.displacement[i]);
        curve.friction.push_back(data_.friction[i]);
        curve.model.push_back(model(out_.best));
        if (laws_.size() == 2 && drawn[1 - out_.best].size() > 0) curve.other.push_back(model(1 - out_.best));
      }
      out_.curves.push_back(std::move(curve));
    }
  }

  const Motion& motion_;
  const RateStateOptions& options_;
  RateStateAnalysis out_;
  RateStateData data_;
  RateStateUnknowns unknowns_;
  std::vector<std::size_t> all_;
  std::vector<RateStateSolution> searched_;  ///< of the laws with the line chosen; empty: not known
  std::vector<LawFit> laws_;
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
