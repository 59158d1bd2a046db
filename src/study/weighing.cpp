#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "diagnosis/limits.hpp"
#include "diagnosis/ruling.hpp"
#include "limits.hpp"
#include "open_question.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

namespace {

/// The value that is not exceeded with this chance, which is kept off 0 and 1 by `least`.
double normal_quantile(double chance, double least) {
  static const boost::math::normal_distribution<double> normal;
  return boost::math::quantile(normal, std::clamp(chance, least, 1 - least));
}

/// Chance that the p-value of another record of the same truth is below `level`, from those of some draws. cycles: so
/// many times as many as the draws had.
double chance_of_p(const std::vector<Evidence>& draws, double level, double cycles) {
  const auto z_of = [](double p) { return normal_quantile(1 - std::clamp(p, 1e-15, 1 - 1e-15), 0); };
  double sum = 0;
  for (const Evidence& draw : draws) sum += z_of(draw.p_value);
  const auto n = static_cast<double>(draws.size());
  return normal_below((std::sqrt(cycles) * sum / n - z_of(level)) / std::sqrt(1 + 1 / n));
}

/// Chance that another record of the same truth distinguishes it from a rival that was `now` behind before the run.
///
/// What the run adds to the difference has, with the right one known, a variance of four times its mean; what the
/// records gave before is what it is. Draws of other parameters spread more, which shows in the draws: the theory
/// counts as kDrawsOfModel of them. The mean is that of the draws, with its error.
double chance_to_distinguish(const std::vector<Evidence>& draws, std::size_t rival, double now,
                             const Lengthening& lengthening) {
  const double longer = lengthening.of_runs;
  double sum = 0, squares = 0, n = 0, size = 0;
  for (const Evidence& draw : draws) {
    if (!std::isfinite(draw.ahead[rival])) continue;
    sum += draw.ahead[rival] - now, n += 1;
    size += draw.least_by_size * lengthening.of_cycles;
  }
  const auto all = static_cast<double>(draws.size());
  if (n == 0) return 1;
  const double added = sum / n, of_theory = 4 * std::max(added, 1.0);
  for (const Evidence& draw : draws) {
    if (std::isfinite(draw.ahead[rival])) squares += std::pow(draw.ahead[rival] - now - added, 2);
  }
  constexpr auto theory = static_cast<double>(kDrawsOfModel);
  const double variance = longer * (theory * of_theory + squares) / (theory + n - 1);
  const double mean = now + longer * added;
  const double least = std::max(diagnosis::limits::kDistinguishable, size / n);
  const double beyond = (mean - least) / std::sqrt(variance * (1 + longer / n));
  return (all - n + n * normal_below(beyond)) / all;
}

/// The records as they are, then the simulated ones.
std::vector<Record> with_runs(const OpenQuestion& question, const std::vector<SimulatedRun>& runs) {
  std::vector<Record> records = question.records();
  for (const SimulatedRun& run : runs) {
    if (run.segmentation.kind != MotionKind::always_sticking) records.push_back({&run.motion, &run.segmentation});
  }
  return records;
}

/// What a diagnosis says, of a truth that is known.
Answer answer_of(const Diagnosis& d, const OpenQuestion& question, std::size_t truth) {
  const auto rung_with = [&](const std::string& key) {
    return std::find_if(d.ladder.begin(), d.ladder.end(), [&](const Rung& rung) {
      const auto& others = rung.equivalent;
      return rung.added == key || std::find(others.begin(), others.end(), key) != others.end();
    });
  };
  bool any = false, possible = false;
  for (const Effect& effect : question.asked) {
    const std::string key = describe(effect).key;
    any |= rung_with(key) != d.ladder.end();
    possible |= std::any_of(d.effects.begin(), d.effects.end(), [&](const EffectFinding& finding) {
      return finding.key == key && finding.status == EffectStatus::possible;
    });
  }
  if (question.without(truth)) return any ? Answer::wrong : possible ? Answer::open : Answer::named;
  const std::string own = describe(question.asked[truth]).key;
  const auto held = rung_with(own);
  if (held == d.ladder.end()) return any ? Answer::wrong : Answer::open;
  return held->added == own && held->equivalent.empty() ? Answer::named : Answer::open;
}

}  // namespace

double chance_of_all(const std::vector<double>& chances) {
  constexpr double kStep = 0.05, kEnd = 6;
  std::vector<double> beyond;
  for (const double chance : chances) beyond.push_back(normal_quantile(chance, 1e-9));
  double sum = 0, weights = 0;
  for (double common = -kEnd; common <= kEnd; common += kStep) {
    const double weight = std::exp(-0.5 * common * common);
    double all = weight;
    for (const double z : beyond) all *= normal_below(std::numbers::sqrt2 * z + common);
    sum += all;
    weights += weight;
  }
  return sum / weights;
}

std::vector<SimulatedRun> runs_of(const OpenQuestion& question, const Experiment& experiment, std::size_t truth,
                                  std::uint64_t draw) {
  const std::uint64_t seed = question.options.seed * 1000003 + draw * 101 + truth;
  std::vector<SimulatedRun> out;
  try {
    const Machine machine = question.draws[truth].draw(seed);
    for (std::size_t k = 0; k < experiment.runs.size(); ++k) {
      out.push_back(simulate_run(machine, experiment.runs[k], question.record, seed + 7919 * (k + 1)));
    }
  } catch (const InputError&) {  // numbers that cannot be simulated
    out.clear();
  }
  return out;
}

double calibrated_chance(double expected) {
  return kGuesses + (1 - kGuesses - kLapses) * expected;
}

Evidence weigh_draw(const OpenQuestion& question, const Experiment& experiment, std::size_t truth, std::uint64_t draw) {
  Evidence out;
  if (experiment.is_by_hand()) {
    out.known = chance_by_hand(question, truth, experiment);
    return out;
  }
  const std::vector<SimulatedRun> runs = runs_of(question, experiment, truth, draw);
  out.simulated = !runs.empty();
  if (!out.simulated) return out;
  const diagnosis::Ruling ruling = diagnosis::rule_between(with_runs(question, runs), question.law, question.beside,
                                                           question.asked, question.options.instruments);
  const auto least = std::min_element(ruling.effects.begin(), ruling.effects.end(),
                                      [](const auto& a, const auto& b) { return a.p_value < b.p_value; });
  const diagnosis::Ruling::OfEffect& own = question.without(truth) ? *least : ruling.effects[truth];
  out.p_value = own.p_value;
  out.least_by_size = ruling.least_by_size;
  out.ruled_out = !own.passes && own.p_value < diagnosis::Limits{}.p_value;
  for (std::size_t k = 0; k < ruling.effects.size(); ++k) {
    const bool rivals = k != truth && ruling.effects[k].passes;
    out.ahead.push_back(rivals ? ruling.effects[k].behind - own.behind : std::numeric_limits<double>::infinity());
  }
  return out;
}

double chance_to_name(const OpenQuestion& question, std::size_t truth, const std::vector<Evidence>& draws,
                      const Lengthening& lengthening) {
  using namespace diagnosis;
  std::vector<Evidence> seen;
  double ruled_out = 0;
  for (const Evidence& draw : draws) {
    if (draw.known >= 0) return draw.known;
    if (!draw.simulated) continue;
    seen.push_back(draw);
    ruled_out += draw.ruled_out ? 1 : 0;
  }
  if (seen.empty()) return 0;
  const auto count = static_cast<double>(seen.size());
  const double simulated = count / static_cast<double>(draws.size());
  if (question.without(truth)) return simulated * (1 - chance_of_p(seen, limits::kChanceOfPossible, 1));
  const double chance = (1 - ruled_out / count) * chance_of_p(seen, Limits{}.p_value, lengthening.of_cycles);
  std::vector<double> of_rivals;
  for (std::size_t rival = 0; rival < question.asked.size(); ++rival) {
    const double now = question.behind[rival] - question.behind[truth];
    if (rival != truth) of_rivals.push_back(chance_to_distinguish(seen, rival, now, lengthening));
  }
  return simulated * std::min(chance, chance_of_all(of_rivals));
}

std::optional<Answer> diagnose_simulated(const OpenQuestion& question, const Experiment& experiment, std::size_t truth,
                                         std::uint64_t draw, double most_cycles) {
  const std::vector<SimulatedRun> runs = runs_of(question, experiment, truth, draw);
  if (runs.empty()) return Answer::open;
  const std::vector<Record> records = with_runs(question, runs);
  std::size_t cycles = 0;
  for (const Record& record : records) cycles += record.segmentation->cycles.size();
  if (static_cast<double>(cycles) > most_cycles) return std::nullopt;
  const PlanOptions& options = question.options;
  DiagnosisOptions inner;
  inner.threads = 1;
  const std::vector<Law> laws = options.laws.empty() ? std::vector<Law>{question.law} : options.laws;
  FitOptions look = options.fit;  // which effects are named is wanted, and no figure of a rung
  look.starts = 0;
  return answer_of(diagnose(records, laws, {}, options.instruments, look, inner).diagnosis, question, truth);
}

}  // namespace tribofit
