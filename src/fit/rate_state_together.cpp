#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "limits.hpp"
#include "rate_state_steps.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit::fit {
namespace {

class Together {
 public:
  Together(const RateStateData& data, LoadPointSource source, const RateStateOptions& options, std::size_t states)
      : source_(source), options_(options) {
    out_.model = {.states = states, .detrend = options.detrend};
    out_.data = data;
    out_.unknowns = unknowns_of(data, states, options.given);
  }

  StepsTogether run() {
    search_lines();
    settle_times();
    fit_laws();
    return std::move(out_);
  }

 private:
  Solution searched(StateEvolution evolution, Detrend detrend) const {
    return search_together(out_.data, {evolution, out_.model.states, detrend}, out_.all(), out_.unknowns);
  }

  /// The line is one over what leaves less; over the displacement where both leave the same. The law is not known yet:
  /// one that is wrong would choose the line that hides most of its own error.
  void search_lines() {
    const std::vector<Detrend> lines = options_.detrend == Detrend::automatic
                                           ? std::vector{Detrend::displacement, Detrend::time}
                                           : std::vector{options_.detrend};
    const std::size_t laws = options_.evolutions.size();
    std::vector<Solution> found(lines.size() * laws);
    run_tasks(found.size(), options_.threads,
              [&](std::size_t i) { found[i] = searched(options_.evolutions[i % laws], lines[i / laws]); });
    std::size_t chosen = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].converged && found[i].cost < least) least = found[i].cost, chosen = i / laws;
    }
    out_.model.detrend = lines[chosen];
    const auto first = found.begin() + static_cast<std::ptrdiff_t>(chosen * laws);
    searched_.assign(first, first + static_cast<std::ptrdiff_t>(laws));
  }

  /// Steps whose times are known to a sample or a second are moved to where the response fits best. A recorded
  /// displacement says when the drive turns; where friction answers at other times beyond chance, those are the times.
  /// Those of the law that then leaves less.
  void settle_times() {
    const bool measured = source_ == LoadPointSource::displacement;
    RateStateData free = out_.data;
    for (VelocityStep& step : free.steps) {
      if (measured) step.slack = kSlackOfDisplacement * shorter_beside(step);
    }
    const std::size_t turns = free_turns(free).size();
    if (turns == 0) return;
    std::vector<RateStateData> moved(searched_.size(), free);
    std::vector<Solution> behind = searched_;
    std::vector<MovedSteps> moves(searched_.size());
    run_tasks(searched_.size(), options_.threads, [&](std::size_t i) {
      if (behind[i].converged) moves[i] = refine_step_times(moved[i], model_of(i), out_.unknowns, behind[i]);
    });
    double least = std::numeric_limits<double>::infinity();  // of any law, its steps where they are said to be
    for (const Solution& one : searched_) {
      if (one.converged) least = std::min(least, one.cost);
    }
    std::size_t best = searched_.size();
    for (std::size_t i = 0; i < searched_.size(); ++i) {
      if (!behind[i].converged || !(behind[i].cost < std::min(least, searched_[i].cost))) continue;
      least = behind[i].cost;
      best = i;
    }
    if (best == searched_.size()) return;
    if (measured && !is_beyond_chance(moved[best], model_of(best), searched_[best], behind[best], turns)) return;
    out_.data = std::move(moved[best]);
    out_.unknowns.starts.insert(out_.unknowns.starts.begin(), behind[best].p);
    searched_.clear();
    say_moved(moves[best], measured);
  }

  void say_moved(const MovedSteps& moves, bool measured) {
    constexpr std::array<const char*, 3> kKnown = {"those stated", "the recorded speed shows",
                                                   "those at which the recorded displacement turns"};
    if (measured || moves.largest > out_.data.steps.front().interval)
      out_.messages.push_back(
          fmt::format("friction answers the steps at other times than {}: they were moved by up to {} s",
                      kKnown.at(static_cast<std::size_t>(source_)), general(moves.largest, 3)));
    out_.at_limit = moves.at_limit;
    if (moves.at_limit.empty()) return;
    out_.messages.push_back(
        fmt::format("the step at {} s was moved as far as its time may be wrong, and friction may answer it later or "
                    "earlier still: the values are not to be trusted; check the column or the times of the load point",
                    general(out_.data.steps[moves.at_limit.front()].time, 6)));
  }

  RateStateModel model_of(std::size_t law) const {
    return {options_.evolutions[law], out_.model.states, out_.model.detrend};
  }

  bool is_beyond_chance(const RateStateData& moved, const RateStateModel& model, const Solution& before,
                        const Solution& behind, std::size_t free) const {
    if (!behind.converged) return false;
    const RateStateProblem fewer(out_.data, model, out_.all());
    const RateStateProblem more = fewer.with_data(moved);
    const RateStateFit fit = fit_from(more, out_.unknowns, behind);
    return fit.converged && p_value_of_more(fewer, before, more, behind, fit, free) < kChanceOfRemark;
  }

  void fit_laws() {
    const std::size_t laws = options_.evolutions.size();
    out_.minima.resize(laws);
    out_.fits.resize(laws);
    run_tasks(laws, options_.threads, [&](std::size_t i) {
      out_.minima[i] =
          searched_.empty() ? searched(options_.evolutions[i], out_.model.detrend) : std::move(searched_[i]);
      out_.fits[i] = fit_from(RateStateProblem(out_.data, model_of(i), out_.all()), out_.unknowns, out_.minima[i]);
      add_messages(out_.fits[i]);
    });
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < laws; ++i) {
      if (out_.fits[i].converged && out_.minima[i].cost < least) least = out_.minima[i].cost, out_.best = i;
    }
  }

  LoadPointSource source_;
  const RateStateOptions& options_;
  StepsTogether out_;
  std::vector<Solution> searched_;  ///< of the laws; empty: the steps were moved since
};

}  // namespace

std::vector<std::size_t> StepsTogether::all() const {
  std::vector<std::size_t> out(data.steps.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

StepsTogether fit_together(const RateStateData& data, LoadPointSource source, const RateStateOptions& options,
                           std::size_t states) {
  return Together(data, source, options, states).run();
}

double p_value_of_more(const RateStateProblem& fewer, const Solution& fewer_minimum, const RateStateProblem& more,
                       const Solution& more_minimum, const RateStateFit& fit, std::size_t values) {
  const double below = log_likelihood_below(more, more_minimum, fewer, fewer_minimum, fit);
  if (!std::isfinite(below)) return std::nan("");
  const auto compared = static_cast<double>(values);
  return f_p_value(2 * std::max(0.0, below) / compared, compared, kLargeFreedom);
}

}  // namespace tribofit::fit
