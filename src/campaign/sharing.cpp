#include "tribofit/campaign/sharing.hpp"
#include "limits.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "condition_columns.hpp"
#include "joint_sharing.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/output/text.hpp"

namespace tribofit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

[[noreturn]] void refuse(const std::string& what, const std::string& name, const std::vector<std::string>& known) {
  const std::string near = likely_name(name, known);
  std::string all;
  for (const std::string& k : known) all += (all.empty() ? "" : ", ") + k;
  throw InputError(what, near.empty() ? "known are " + all : "did you mean " + near + "?");
}

/// A run as the joint fit of one law sees it.
struct Member {
  std::size_t run = 0;
  VectorXd y;
  MatrixXd covariance;
  std::vector<bool> usable;  ///< an error that is known, and not on a bound
};

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

Member member_of(std::size_t run, const ResultFit& fit) {
  const auto n = static_cast<Index>(fit.parameters.size());
  Member out{run, VectorXd(n), MatrixXd::Zero(n, n), {}};
  for (Index i = 0; i < n; ++i) {
    const ResultParameter& p = fit.parameters[static_cast<std::size_t>(i)];
    out.y(i) = p.value;
    out.usable.push_back(std::isfinite(p.std_error) && p.std_error > 0 && !p.at_bound);
  }
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      const bool both = out.usable[static_cast<std::size_t>(i)] && out.usable[static_cast<std::size_t>(j)];
      if (both) out.covariance(i, j) = fit.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
    if (!(out.covariance(i, i) > 0)) out.covariance(i, i) = 1;  // not used
  }
  out.covariance = made_positive(out.covariance);
  return out;
}

/// Where the common parameters stand: level of each run and the values found.
struct Place {
  Index parameter = 0;
  std::vector<std::size_t> level;  ///< of each member
  const SharedFit::Parameter* found = nullptr;
};

/// How much member i counts in the value of its level.
double weight_of(const Place& place, const std::vector<Member>& members, std::size_t i) {
  const PooledValue& value = place.found->values[place.level[i]];
  const auto k = static_cast<std::size_t>(place.parameter);
  if (!members[i].usable[k]) return 0;
  const double between = std::isfinite(value.between) ? value.between : 0;
  return 1 / (members[i].covariance(place.parameter, place.parameter) + between * between);
}

/// Covariance of the values of the levels at which member i stands.
MatrixXd covariance_of_levels(const std::vector<const Place*>& places, const std::vector<Member>& members,
                              std::size_t i) {
  const auto n = static_cast<Index>(places.size());
  MatrixXd raw = MatrixXd::Zero(n, n);
  for (std::size_t j = 0; j < members.size(); ++j) {
    for (Index a = 0; a < n; ++a) {
      for (Index b = 0; b <= a; ++b) {
        const Place &p = *places[static_cast<std::size_t>(a)], &q = *places[static_cast<std::size_t>(b)];
        if (p.level[j] != p.level[i] || q.level[j] != q.level[i]) continue;
        double shared = members[j].covariance(p.parameter, q.parameter);
        const double between = p.found->values[p.level[i]].between;
        if (a == b && std::isfinite(between)) shared += between * between;
        raw(a, b) += weight_of(p, members, j) * weight_of(q, members, j) * shared;
      }
    }
  }
  MatrixXd out(n, n);
  for (Index a = 0; a < n; ++a) {
    for (Index b = 0; b < n; ++b) {
      const double r = raw(std::max(a, b), std::min(a, b)) / std::sqrt(raw(a, a) * raw(b, b));
      const auto error = [&](Index c) {
        const Place& place = *places[static_cast<std::size_t>(c)];
        return place.found->values[place.level[i]].std_error;
      };
      out(a, b) = r * error(a) * error(b);
    }
  }
  return out;
}

/// The parameters of member i, given what is common.
SharedFit::OfRun of_run(const std::vector<Place>& places, const std::vector<Member>& members, std::size_t i) {
  const Member& m = members[i];
  const Index n = m.y.size();
  SharedFit::OfRun out{m.run, {}, {}};
  std::vector<const Place*> here;
  for (const Place& place : places) {
    if (m.usable[static_cast<std::size_t>(place.parameter)]) here.push_back(&place);
  }
  VectorXd value = m.y, error = m.covariance.diagonal().cwiseSqrt();
  const auto s = static_cast<Index>(here.size());
  if (s > 0) {
    VectorXd off(s), scatter(s);
    MatrixXd own(s, s), with_all(n, s);
    for (Index a = 0; a < s; ++a) {
      const Place& place = *here[static_cast<std::size_t>(a)];
      const PooledValue& level = place.found->values[place.level[i]];
      off(a) = m.y(place.parameter) - level.value;
      // A level of one run: its own value stands.
      scatter(a) = std::isfinite(level.between) ? level.between * level.between : 0;
      for (Index b = 0; b < s; ++b) {
        own(a, b) = m.covariance(place.parameter, here[static_cast<std::size_t>(b)]->parameter);
      }
      with_all.col(a) = m.covariance.col(place.parameter);
    }
    const MatrixXd keep = scatter.asDiagonal() * inverse_of(own + MatrixXd(scatter.asDiagonal()));  // of what is off
    const MatrixXd rest = MatrixXd::Identity(s, s) - keep;
    const VectorXd moved = keep * off - off;  // from the run's own values to the predicted ones
    const MatrixXd predicted =
        rest * MatrixXd(scatter.asDiagonal()) + rest * covariance_of_levels(here, members, i) * rest.transpose();
    const MatrixXd follow = with_all * inverse_of(own);
    value += follow * moved;
    const MatrixXd left = m.covariance - follow * with_all.transpose() + follow * predicted * follow.transpose();
    error = left.diagonal().cwiseMax(0).cwiseSqrt();
  }
  for (Index k = 0; k < n; ++k) {
    const bool usable = m.usable[static_cast<std::size_t>(k)];
    out.value.push_back(usable ? value(k) : m.y(k));
    out.std_error.push_back(usable ? error(k) : std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

/// Values of a common parameter, level by level.
SharedFit::Parameter pool_levels(const Sharing::Common& common, const std::vector<Member>& members, Index parameter,
                                 const std::vector<std::string>& text, std::span<const RunResult> runs,
                                 const ResultFit& like, std::vector<std::size_t>& level) {
  SharedFit::Parameter out{common.parameter, common.condition, {}, {}};
  for (const Member& member : members) {
    const std::string& here = text[member.run];
    const auto at = std::find(out.levels.begin(), out.levels.end(), here);
    level.push_back(static_cast<std::size_t>(at - out.levels.begin()));
    if (at == out.levels.end()) out.levels.push_back(here);
  }
  const auto k = static_cast<std::size_t>(parameter);
  for (std::size_t l = 0; l < out.levels.size(); ++l) {
    std::vector<double> values, errors, systematic;
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (level[i] != l) continue;
      values.push_back(members[i].y(parameter));
      errors.push_back(members[i].usable[k] ? std::sqrt(members[i].covariance(parameter, parameter))
                                            : std::numeric_limits<double>::quiet_NaN());
      systematic.push_back(runs[members[i].run].fit(like.law, like.protocol)->parameters[k].systematic);
    }
    out.values.push_back(pool(like.parameters[k].name, like.parameters[k].unit, values, errors, systematic));
    out.values.back().effect = like.parameters[k].effect;
  }
  return out;
}

/// Says where runs differ by far more than their own errors.
void note_scatter(const SharedFit::Parameter& common, std::vector<std::string>& notes) {
  for (std::size_t l = 0; l < common.values.size(); ++l) {
    const PooledValue& value = common.values[l];
    const double own = value.statistical * std::sqrt(static_cast<double>(value.runs));
    if (!(value.between > kManyErrors * own)) continue;
    const std::string where = common.condition.empty() ? "" : " at " + common.condition + " " + common.levels[l];
    notes.push_back(
        fmt::format("{}{} differs from run to run by {}{}, many times what the errors of the runs allow, so "
                    "it is hardly common to them; --vary {}:CONDITION gives one value for each value of a condition",
                    common.name, where, general(value.between, 2), unit_behind(value.unit), common.name));
  }
}

/// Refuses a parameter that no law has, or that is named twice.
void require_known(const Sharing& sharing, const std::vector<const ResultFit*>& laws) {
  std::vector<std::string> known;
  for (const ResultFit* law : laws) {
    for (const ResultParameter& p : law->parameters) {
      if (std::find(known.begin(), known.end(), full_name(p.name, p.effect)) == known.end())
        known.push_back(full_name(p.name, p.effect));
    }
  }
  for (std::size_t c = 0; c < sharing.common.size(); ++c) {
    const std::string& parameter = sharing.common[c].parameter;
    if (std::find(known.begin(), known.end(), parameter) == known.end())
      refuse("no law has a parameter '" + parameter + "'", parameter, known);
    for (std::size_t d = 0; d < c; ++d) {
      if (sharing.common[d].parameter != parameter) continue;
      throw InputError("'" + parameter + "' is named twice in --share and --vary", "name it once");
    }
  }
}

/// For every common parameter its condition in every run, as text; empty texts where it has none.
std::vector<std::vector<std::string>> condition_texts(const Sharing& sharing, std::span<const RunResult> runs) {
  const std::vector<ConditionColumn> conditions = condition_columns(runs);
  std::vector<std::vector<std::string>> texts;
  for (const Sharing::Common& common : sharing.common) {
    texts.emplace_back(runs.size());
    if (common.condition.empty()) continue;
    const auto at = std::find_if(conditions.begin(), conditions.end(),
                                 [&](const ConditionColumn& column) { return column.name == common.condition; });
    if (at == conditions.end()) {
      std::vector<std::string> names;
      for (const ConditionColumn& column : conditions) names.push_back(column.name);
      refuse("no run states a condition '" + common.condition + "'", common.condition, names);
    }
    texts.back() = at->text;
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
  std::vector<Member> members;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const ResultFit* own = runs[r].fit(like.law, to_string(Protocol::joint));
    if (own != nullptr && own->covariance.size() == fit.names.size()) {
      members.push_back(member_of(r, *own));
    } else if (runs[r].run.status == RunStatus::ok) {
      fit.notes.push_back(fmt::format("{} has no {} fit with errors and is not used", runs[r].run.name, like.law));
    }
  }
  std::vector<Place> places;
  fit.common.reserve(sharing.common.size());  // places point into it
  for (std::size_t c = 0; c < sharing.common.size(); ++c) {
    const auto at = std::find(fit.names.begin(), fit.names.end(), sharing.common[c].parameter);
    if (at == fit.names.end()) continue;  // of the other law
    Place place{at - fit.names.begin(), {}, nullptr};
    fit.common.push_back(pool_levels(sharing.common[c], members, place.parameter, texts[c], runs, like, place.level));
    place.found = &fit.common.back();
    places.push_back(std::move(place));
  }
  if (fit.common.empty()) return fit;
  if (results != nullptr) {
    SharedLaw law{like, {}, {}, {}};
    for (const Member& member : members) law.runs.push_back(member.run);
    for (const Place& place : places) {
      law.parameters.push_back(static_cast<std::size_t>(place.parameter));
      law.level.push_back(place.level);
    }
    const std::string why = fit_jointly(*results, runs, law, fit);
    if (!why.empty()) fit.notes.push_back("the single fits are combined, not all samples fitted together: " + why);
  }
  if (fit.is_joint) return fit;
  for (const SharedFit::Parameter& common : fit.common) note_scatter(common, fit.notes);
  for (std::size_t i = 0; i < members.size(); ++i) fit.runs.push_back(of_run(places, members, i));
  return fit;
}

}  // namespace

Sharing::Common share_from(const std::string& text) {
  if (text.find(':') != std::string::npos) {
    throw InputError("'" + text + "' shares over a condition", "--vary " + text + " gives one value for each");
  }
  return {text, ""};
}

Sharing::Common vary_from(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == 0 || colon == std::string::npos || colon + 1 == text.size()) {
    throw InputError("'" + text + "' is not PARAMETER:CONDITION", "as in --vary mu_s:radius");
  }
  return {text.substr(0, colon), text.substr(colon + 1)};
}

std::vector<SharedFit> fit_shared(std::span<const RunResult> runs, const Sharing& sharing,
                                  const ResultReader* results) {
  const std::vector<const ResultFit*> laws = joint_fits(runs, true);
  if (laws.empty()) throw InputError("no run was fitted, so there is nothing to share", "see why in the summary");
  require_known(sharing, laws);
  const std::vector<std::vector<std::string>> texts = condition_texts(sharing, runs);
  std::vector<SharedFit> out;
  for (const ResultFit* like : laws) {
    SharedFit fit = fit_law(*like, runs, sharing, texts, results);
    if (!fit.common.empty()) out.push_back(std::move(fit));
  }
  return out;
}

}  // namespace tribofit
