#include "tribofit/campaign/sharing.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "conditions.hpp"
#include "joint_sharing.hpp"
#include "limits.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Refuses a name that is not known. what: "there is no ...".
void require_known(const std::string& name, const std::vector<std::string>& known, const std::string& what) {
  if (std::ranges::find(known, name) != known.end()) return;
  const std::string near = likely_name(name, known);
  throw InputError(what + " '" + name + "'",
                   near.empty() ? "known are " + listed(known) : "did you mean " + near + "?");
}

/// Errors that were estimated one by one need not fit together: correlations are drawn in until they do.
MatrixXd made_positive(const MatrixXd& covariance) {
  const VectorXd scale = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const MatrixXd correlation = scale.cwiseInverse().asDiagonal() * covariance * scale.cwiseInverse().asDiagonal();
  const VectorXd eigenvalues = symmetric_eigen(correlation).values;
  if (eigenvalues(0) > kLeastEigenvalue) return covariance;
  const double least = std::min(0.0, eigenvalues(0));
  const MatrixXd drawn_in =
      (correlation + (kLeastEigenvalue - least) * MatrixXd::Identity(scale.size(), scale.size())) /
      (1 + kLeastEigenvalue - least);
  return scale.asDiagonal() * drawn_in * scale.asDiagonal();
}

/// The single fit of a run as fit_shared() combines it.
struct Member {
  VectorXd y;
  MatrixXd covariance;
  std::vector<bool> usable;  ///< an error that is known, and not on a bound
};

Member member_of(const ResultFit& fit) {
  const auto n = static_cast<Index>(fit.parameters.size());
  Member out{VectorXd(n), MatrixXd::Zero(n, n), {}};
  for (const ResultParameter& p : fit.parameters) {
    out.y(static_cast<Index>(out.usable.size())) = p.value;
    out.usable.push_back(p.has_error());
  }
  for (std::size_t i = 0; i < out.usable.size(); ++i) {
    const auto row = static_cast<Index>(i);
    for (std::size_t j = 0; j < out.usable.size(); ++j) {
      if (out.usable[i] && out.usable[j]) out.covariance(row, static_cast<Index>(j)) = fit.covariance[i][j];
    }
    if (!(out.covariance(row, row) > 0)) out.covariance(row, row) = 1;  // not used
  }
  out.covariance = made_positive(out.covariance);
  return out;
}

double square_or_zero(double deviation) {
  return std::isfinite(deviation) ? deviation * deviation : 0;
}

/// The single fits of one law together: common values, and what follows from them for each run.
class SingleFits {
 public:
  SingleFits(std::span<const RunResult> runs, SharedLaw& law, SharedFit& fit) : runs_(runs), law_(law), fit_(fit) {
    for (const std::size_t r : law.runs) members_.push_back(member_of(*fit_of(r)));
  }

  /// Pools the values of a common parameter, level by level. text: its condition in every run.
  void pool_levels(const Sharing::Common& common, std::size_t parameter, const std::vector<std::string>& text) {
    SharedFit::Parameter out{common.parameter, common.condition, {}, {}};
    std::vector<std::size_t> level;
    for (const std::size_t r : law_.runs) level.push_back(place_in(out.levels, text[r]));
    const ResultParameter& like = law_.like.parameters[parameter];
    const auto k = static_cast<Index>(parameter);
    for (std::size_t l = 0; l < out.levels.size(); ++l) {
      std::vector<RunValue> values;
      for (std::size_t i = 0; i < members_.size(); ++i) {
        if (level[i] != l) continue;
        const Member& m = members_[i];
        values.push_back({m.y(k), m.usable[parameter] ? std::sqrt(m.covariance(k, k)) : kUnknown,
                          fit_of(law_.runs[i])->parameters[parameter].systematic});
      }
      out.values.push_back(pool(like.name, like.unit, std::move(values)));
      out.values.back().effect = like.effect;
    }
    fit_.common.push_back(std::move(out));
    law_.parameters.push_back(parameter);
    law_.level.push_back(std::move(level));
  }

  /// The parameters of member i, given what is common.
  SharedFit::OfRun of_run(std::size_t i) const {
    const Member& m = members_[i];
    const Index n = m.y.size();
    SharedFit::OfRun out{law_.runs[i], {}, {}};
    std::vector<std::size_t> here;  // what it says something of
    for (std::size_t c = 0; c < law_.parameters.size(); ++c) {
      if (m.usable[law_.parameters[c]]) here.push_back(c);
    }
    VectorXd value = m.y, error = m.covariance.diagonal().cwiseSqrt();
    const auto s = static_cast<Index>(here.size());
    if (s > 0) {
      VectorXd off(s), scatter(s);
      MatrixXd own(s, s), with_all(n, s);
      for (Index a = 0; a < s; ++a) {
        const std::size_t c = here[static_cast<std::size_t>(a)];
        off(a) = m.y(index(c)) - value_at(c, i).value;
        scatter(a) = square_or_zero(value_at(c, i).between);  // a level of one run: its own value stands
        for (Index b = 0; b < s; ++b) own(a, b) = m.covariance(index(c), index(here[static_cast<std::size_t>(b)]));
        with_all.col(a) = m.covariance.col(index(c));
      }
      const MatrixXd keep = scatter.asDiagonal() * inverse_of(own + MatrixXd(scatter.asDiagonal()));  // of what is off
      const MatrixXd rest = MatrixXd::Identity(s, s) - keep;
      const VectorXd moved = keep * off - off;  // from the run's own values to the predicted ones
      const MatrixXd predicted =
          rest * MatrixXd(scatter.asDiagonal()) + rest * covariance_of_levels(here, i) * rest.transpose();
      const MatrixXd follow = with_all * inverse_of(own);
      value += follow * moved;
      const MatrixXd left = m.covariance - follow * with_all.transpose() + follow * predicted * follow.transpose();
      error = left.diagonal().cwiseMax(0).cwiseSqrt();
    }
    for (Index k = 0; k < n; ++k) {
      const bool usable = m.usable[static_cast<std::size_t>(k)];
      out.value.push_back(usable ? value(k) : m.y(k));
      out.std_error.push_back(usable ? error(k) : kUnknown);
    }
    return out;
  }

 private:
  const ResultFit* fit_of(std::size_t run) const { return runs_[run].fit(law_.like.law, law_.like.protocol); }
  Index index(std::size_t common) const { return static_cast<Index>(law_.parameters[common]); }
  /// Of a common parameter, where member i stands.
  const PooledValue& value_at(std::size_t common, std::size_t i) const {
    return fit_.common[common].values[law_.level[common][i]];
  }

  /// How much a member counts in the value of its level.
  double weight_of(std::size_t common, std::size_t i) const {
    if (!members_[i].usable[law_.parameters[common]]) return 0;
    const Index k = index(common);
    return 1 / (members_[i].covariance(k, k) + square_or_zero(value_at(common, i).between));
  }

  /// Covariance of the values of the levels at which member i stands.
  MatrixXd covariance_of_levels(const std::vector<std::size_t>& commons, std::size_t i) const {
    const auto n = static_cast<Index>(commons.size());
    const auto common = [&](Index a) { return commons[static_cast<std::size_t>(a)]; };
    MatrixXd raw = MatrixXd::Zero(n, n), out(n, n);
    for (std::size_t j = 0; j < members_.size(); ++j) {
      for (Index a = 0; a < n; ++a) {
        for (Index b = 0; b <= a; ++b) {
          const std::size_t p = common(a), q = common(b);
          if (law_.level[p][j] != law_.level[p][i] || law_.level[q][j] != law_.level[q][i]) continue;
          double shared = members_[j].covariance(index(p), index(q));
          if (a == b) shared += square_or_zero(value_at(p, i).between);
          raw(a, b) += weight_of(p, j) * weight_of(q, j) * shared;
        }
      }
    }
    for (Index a = 0; a < n; ++a) {
      for (Index b = 0; b < n; ++b) {
        const double r = raw(std::max(a, b), std::min(a, b)) / std::sqrt(raw(a, a) * raw(b, b));
        out(a, b) = r * value_at(common(a), i).std_error * value_at(common(b), i).std_error;
      }
    }
    return out;
  }

  std::span<const RunResult> runs_;
  SharedLaw& law_;
  SharedFit& fit_;
  std::vector<Member> members_;
};

/// Says where runs differ by far more than their own errors.
void note_scatter(const SharedFit::Parameter& common, std::vector<std::string>& notes) {
  for (std::size_t l = 0; l < common.values.size(); ++l) {
    const PooledValue& value = common.values[l];
    const double own = value.statistical * std::sqrt(static_cast<double>(value.runs));
    if (!(value.between > kManyErrors * own)) continue;
    notes.push_back(
        fmt::format("{} differs from run to run by {}{}, many times what the errors of the runs allow, so "
                    "it is hardly common to them; --vary {}:CONDITION gives one value for each value of a condition",
                    common.at(l), general(value.between, 2), unit_behind(value.unit), common.name));
  }
}

/// For every common parameter its condition in every run, as text; empty texts where it has none.
std::vector<std::vector<std::string>> condition_texts(const Sharing& sharing, std::span<const RunResult> runs) {
  const std::vector<ConditionColumn> conditions = condition_columns(runs);
  std::vector<std::string> names;
  for (const ConditionColumn& column : conditions) names.push_back(column.name);
  std::vector<std::vector<std::string>> texts;
  for (const Sharing::Common& common : sharing.common) {
    texts.emplace_back(runs.size());
    if (common.condition.empty()) continue;
    require_known(common.condition, names, "no run states a condition");
    texts.back() = std::ranges::find(conditions, common.condition, &ConditionColumn::name)->text;
  }
  return texts;
}

/// The joint fit of one law; without common parameters where the law has none of them.
SharedFit fit_law(const ResultFit& like, std::span<const RunResult> runs, const Sharing& sharing,
                  const std::vector<std::vector<std::string>>& texts, const ResultReader* results) {
  SharedFit fit;
  fit.law = like.law;
  for (const ResultParameter& p : like.parameters) {
    fit.names.push_back(full_name(p.name, p.effect));
    fit.units.push_back(p.unit);
  }
  SharedLaw law{like, {}, {}, {}};
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const ResultFit* own = runs[r].fit(like.law, like.protocol);
    if (own != nullptr && own->covariance.size() == fit.names.size()) {
      law.runs.push_back(r);
    } else if (runs[r].run.status == RunStatus::ok) {
      fit.notes.push_back(fmt::format("{} has no {} fit with errors and is not used", runs[r].run.name, like.law));
    }
  }
  SingleFits single(runs, law, fit);
  for (std::size_t c = 0; c < sharing.common.size(); ++c) {
    const auto at = std::ranges::find(fit.names, sharing.common[c].parameter);
    if (at == fit.names.end()) continue;  // of the other law
    single.pool_levels(sharing.common[c], static_cast<std::size_t>(at - fit.names.begin()), texts[c]);
  }
  if (fit.common.empty()) return fit;
  if (results != nullptr) {
    const std::string why = fit_jointly(*results, runs, law, fit);
    if (!why.empty()) fit.notes.push_back("the single fits are combined, not all samples fitted together: " + why);
  }
  if (fit.is_joint) return fit;
  for (const SharedFit::Parameter& common : fit.common) note_scatter(common, fit.notes);
  for (std::size_t i = 0; i < law.runs.size(); ++i) fit.runs.push_back(single.of_run(i));
  return fit;
}

}  // namespace

Sharing sharing_from(const std::vector<std::string>& share, const std::vector<std::string>& vary) {
  Sharing sharing;
  const auto add = [&](Sharing::Common common) {
    if (std::ranges::find(sharing.common, common.parameter, &Sharing::Common::parameter) != sharing.common.end())
      throw InputError("'" + common.parameter + "' is named twice in --share and --vary", "");
    sharing.common.push_back(std::move(common));
  };
  for (const std::string& text : share) {
    if (text.find(':') != std::string::npos)
      throw InputError("'" + text + "' shares over a condition", "--vary " + text + " gives one value for each");
    add({text, ""});
  }
  for (const std::string& text : vary) {
    const std::size_t colon = text.find(':');
    if (colon == 0 || colon == std::string::npos || colon + 1 == text.size())
      throw InputError("'" + text + "' is not PARAMETER:CONDITION", "as in --vary mu_s:radius");
    add({text.substr(0, colon), text.substr(colon + 1)});
  }
  return sharing;
}

std::vector<SharedFit> fit_shared(std::span<const RunResult> runs, const Sharing& sharing,
                                  const ResultReader* results) {
  const std::vector<const ResultFit*> laws = joint_fits(runs, true);
  if (laws.empty()) throw InputError("no run was fitted, so there is nothing to share", "see why in the summary");
  std::vector<std::string> known;
  for (const ResultFit* law : laws) {
    for (const ResultParameter& p : law->parameters) place_in(known, full_name(p.name, p.effect));
  }
  for (const Sharing::Common& common : sharing.common) require_known(common.parameter, known, "no law has a parameter");
  const std::vector<std::vector<std::string>> texts = condition_texts(sharing, runs);
  std::vector<SharedFit> out;
  for (const ResultFit* like : laws) {
    SharedFit fit = fit_law(*like, runs, sharing, texts, results);
    if (!fit.common.empty()) out.push_back(std::move(fit));
  }
  return out;
}

}  // namespace tribofit
