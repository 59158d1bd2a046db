#include "growth_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "limits.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::segmentation {
namespace {

/// lambda of a window over that of the others.
double faster_in(const Window& window, const Growth& growth) {
  return std::clamp(1 + growth.gain * window.excess, 1 / kMostFaster, kMostFaster);
}

/// Sums over samples, N side by side: the exponential runs by recurrence, and one by one each sample would wait for the
/// one before. Derivatives of the model by log A, log lambda and B; that by the gain is made of the first two.
template <int N, bool with_shared>
struct RunningSums {
  using Samples = Eigen::Array<double, N, 1>;
  enum Term { kRss, kH, kG, kMixed, kGradient = kMixed + 3, kShared = kGradient + 3, kAll = kShared + 6 };
  std::array<Samples, with_shared ? kAll : kMixed> terms;

  RunningSums() { terms.fill(Samples::Zero()); }

  /// x: lambda (t - t0) of the samples; e: its exponential; v: what was measured.
  void add(const Growth& growth, const Samples& x, const Samples& e, const Samples& v) {
    const Samples shape = e - 1 - x, rise = e - 1;
    const Samples r = v - growth.a * shape - growth.b * rise;
    const Samples slope = growth.a * rise + growth.b * e;  // dv/dx
    const Samples d = -growth.lambda * slope;              // dv/dt0
    terms[kRss] += r * r;
    terms[kH] += d * d;
    terms[kG] += d * r;
    if constexpr (with_shared) {
      const std::array<Samples, 3> j = {growth.a * shape, x * slope, rise};
      std::size_t product = kShared;
      for (std::size_t k = 0; k < j.size(); ++k) {
        terms[kMixed + k] += d * j[k];
        terms[kGradient + k] += j[k] * r;
        for (std::size_t l = k; l < j.size(); ++l) terms[product++] += j[k] * j[l];
      }
    }
  }

  double sum(std::size_t term) const { return terms[term].sum(); }
};

/// Of both, by all four parameters. by_gain: d lambda / d gain over lambda.
template <int N>
void fill_shared(const RunningSums<N, true>& many, const RunningSums<1, true>& last, double by_gain, Sums& out) {
  using Running = RunningSums<1, true>;
  const auto sum = [&](std::size_t term) { return many.sum(term) + last.sum(term); };
  const auto vector = [&](std::size_t first) { return Eigen::Vector3d(sum(first), sum(first + 1), sum(first + 2)); };
  Eigen::Matrix3d products;
  std::size_t term = Running::kShared;
  for (Eigen::Index k = 0; k < 3; ++k)
    for (Eigen::Index l = k; l < 3; ++l) products(k, l) = products(l, k) = sum(term++);
  Eigen::Matrix<double, 4, 3> with_gain = Eigen::Matrix<double, 4, 3>::Identity();
  with_gain.row(3) << -2 * by_gain, by_gain, 0;
  out.mixed = with_gain * vector(Running::kMixed);
  out.gradient = with_gain * vector(Running::kGradient);
  out.shared = with_gain * products * with_gain.transpose();
}

template <bool with_shared>
Sums sums_at(const Window& w, const Growth& common, double t0) {
  constexpr int kSideBySide = 4;
  using Samples = Eigen::Array<double, kSideBySide, 1>;
  using One = Eigen::Array<double, 1, 1>;
  const Growth growth = growth_in(w, common);
  const double factor = std::exp(growth.lambda), factor_of_all = std::pow(factor, kSideBySide);
  std::size_t i = std::min(static_cast<std::size_t>(std::max(0.0, std::ceil(t0))), w.v.size());
  Sums s;
  s.rss = w.squares[i];
  Samples x, e;
  for (int k = 0; k < kSideBySide; ++k) {
    x(k) = growth.lambda * (static_cast<double>(i) + k - t0);
    e(k) = k == 0 ? std::exp(x(0)) : e(k - 1) * factor;
  }
  RunningSums<kSideBySide, with_shared> many;
  for (; i + kSideBySide <= w.v.size(); i += kSideBySide, x += kSideBySide * growth.lambda, e *= factor_of_all)
    many.add(growth, x, e, Eigen::Map<const Samples>(w.v.data() + i));
  RunningSums<1, with_shared> last;
  for (int k = 0; i < w.v.size(); ++i, ++k) last.add(growth, One(x(k)), One(e(k)), One(w.v[i]));
  using Running = RunningSums<1, with_shared>;
  s.rss += many.sum(Running::kRss) + last.sum(Running::kRss);
  s.h = many.sum(Running::kH) + last.sum(Running::kH);
  s.g = many.sum(Running::kG) + last.sum(Running::kG);
  if constexpr (with_shared) fill_shared(many, last, w.excess / faster_in(w, common), s);
  return s;
}

/// What the windows say of the growth that they share, each with its own break-away taken out.
struct SharedGrowth {
  Eigen::Matrix4d hessian = Eigen::Matrix4d::Zero();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  std::vector<Sums> windows;
};

SharedGrowth shared_growth(const std::vector<Window>& windows, const Growth& growth, const std::vector<double>& times,
                           FreeGrowth free) {
  SharedGrowth out;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    out.windows.push_back(sums_at<true>(windows[i], growth, times[i]));
    const Sums& s = out.windows.back();
    out.hessian += s.shared;
    out.gradient += s.gradient;
    if (s.h <= 0) continue;
    out.hessian -= s.mixed * s.mixed.transpose() / s.h;
    out.gradient -= s.mixed * (s.g / s.h);
  }
  const auto hold = [&out](int k) {
    out.hessian.row(k).setZero(), out.hessian.col(k).setZero();
    out.hessian(k, k) = 1, out.gradient(k) = 0;
  };
  if (!free.jump) hold(2);
  if (!free.gain) hold(3);
  return out;
}

/// A growth and the break-away of each window with it.
struct Trial {
  Growth growth;
  std::vector<double> times;
  double rss = 0;
};

double squares_left(const std::vector<Window>& windows, const Growth& growth, const std::vector<double>& times) {
  double rss = 0;
  for (std::size_t i = 0; i < windows.size(); ++i) rss += sums_at<false>(windows[i], growth, times[i]).rss;
  return rss;
}

/// The next trial by Levenberg and Marquardt.
Trial damped_step(const std::vector<Window>& windows, const SharedGrowth& shared, Trial trial, double damping,
                  FreeGrowth free) {
  Eigen::Matrix4d damped = shared.hessian;
  damped.diagonal() *= 1 + damping;
  const Eigen::Vector4d step = solve_symmetric(damped, shared.gradient);
  trial.growth.a *= std::exp(std::clamp(step(0), -1.0, 1.0));
  trial.growth.lambda *= std::exp(std::clamp(step(1), -0.5, 0.5));
  trial.growth.b = free.jump ? std::max(0.0, trial.growth.b + step(2)) : 0;
  if (free.gain) trial.growth.gain += step(3);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const Sums& s = shared.windows[i];
    if (s.h > 0) trial.times[i] += (s.g - s.mixed.dot(step)) / s.h;
    trial.times[i] = std::clamp(trial.times[i], -2.0, windows[i].crossing);
  }
  trial.rss = std::isfinite(step.sum()) ? squares_left(windows, trial.growth, trial.times) : HUGE_VAL;
  return trial;
}

PooledFit fit_all(std::vector<Window>& windows, Growth growth, FreeGrowth free) {
  PooledFit fit;
  Trial best{growth, {}, 0};
  for (const Window& w : windows) {
    // From the start of fit_common_growth(); a smaller pull takes longer to the same velocity.
    best.times.push_back(std::max(0.0, w.crossing - (2 - std::log(w.pull)) / growth.lambda));
    fit.samples += w.v.size();
  }
  best.rss = squares_left(windows, growth, best.times);
  double damping = 1e-3;
  for (int iteration = 0; iteration < 30; ++iteration) {
    const SharedGrowth shared = shared_growth(windows, best.growth, best.times, free);
    fit.information = shared.hessian;
    double gain = 0;
    for (int attempt = 0; attempt < 8 && gain == 0; ++attempt) {
      Trial next = damped_step(windows, shared, best, damping, free);
      const bool is_better = next.rss < best.rss;
      damping = is_better ? std::max(1e-6, damping * 0.2) : std::min(1e6, 8 * (damping + 1e-4));
      if (!is_better) continue;
      gain = best.rss - next.rss;
      best = std::move(next);
    }
    if (gain == 0 || gain < 1e-7 * best.rss) break;
  }
  fit.growth = best.growth;
  fit.rss = best.rss;
  for (std::size_t i = 0; i < windows.size(); ++i) windows[i].t0 = best.times[i];
  return fit;
}

/// Takes out the few windows in which something else than the growth of the others happens. Whether there are any.
bool take_out_foreign(std::vector<Window>& windows, const Growth& growth) {
  std::vector<double> left;
  for (const Window& w : windows) left.push_back(sums_at<false>(w, growth, w.t0).rss / static_cast<double>(w.v.size()));
  const double most = kForeignRise * median(left);
  const auto foreign = static_cast<std::size_t>(std::ranges::count_if(left, [&](double x) { return x > most; }));
  if (foreign == 0 || foreign * kRisesPerForeign > windows.size()) return false;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    if (left[i] <= most) std::swap(windows[kept++], windows[i]);
  }
  windows.resize(kept);
  return true;
}

}  // namespace

Growth growth_in(const Window& window, const Growth& growth) {
  const double faster = faster_in(window, growth);
  return {window.pull * growth.a / (faster * faster), growth.lambda * faster, growth.b, growth.gain};
}

Sums sums_of(const Window& window, const Growth& growth, double t0) {
  return sums_at<true>(window, growth, t0);
}

double fit_time(const Window& w, const Growth& growth, double start) {
  double t0 = std::clamp(start, -2.0, w.crossing);
  Sums here = sums_at<false>(w, growth, t0);
  for (int k = 0; k < 20 && here.h > 0; ++k) {
    double step = std::clamp(here.g / here.h, -5 / growth.lambda, 5 / growth.lambda);
    bool better = false;
    for (int half = 0; half < 6 && !better; ++half, step *= 0.5) {
      const double next = std::clamp(t0 + step, -2.0, w.crossing);
      const Sums there = sums_at<false>(w, growth, next);
      if (there.rss < here.rss) t0 = next, here = there, better = true;
    }
    if (!better || std::abs(step) < 1e-3) break;
  }
  return t0;
}

PooledFit fit_growth(std::vector<Window>& windows, Growth growth, FreeGrowth free) {
  const PooledFit fit = fit_all(windows, growth, free);
  // Those moved the growth and the times of the others: from the start again.
  return take_out_foreign(windows, fit.growth) ? fit_all(windows, growth, free) : fit;
}

Noise noise_of(const std::vector<Window>& windows, const Growth& growth) {
  Remainder all;
  for (const Window& w : windows) {
    Remainder left;
    const Growth own = growth_in(w, growth);
    for (std::size_t i = 0; i < w.v.size(); ++i) {
      const double t = static_cast<double>(i) - w.t0;
      const double x = t > 0 ? own.lambda * t : 0;
      left.add(w.v[i] - own.a * (std::expm1(x) - x) - own.b * std::expm1(x));
    }
    all += left;
  }
  if (all.squares <= 0) return {};
  return {all.squares / all.count, variance_inflation(all.correlation(kMostCorrelation))};
}

}  // namespace tribofit::segmentation
