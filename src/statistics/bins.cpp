#include "tribofit/statistics/bins.hpp"

#include <algorithm>
#include <cmath>

#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

BinnedSamples::BinnedSamples(double from, double to, std::size_t bins)
    : from_(from), width_((to - from) / static_cast<double>(bins)), bins_(bins) {}

void BinnedSamples::add(double x, double y) {
  const double at = (x - from_) / width_;
  if (!(at >= 0) || !(at <= static_cast<double>(bins_.size())) || !std::isfinite(y)) return;
  Bin& bin = bins_[std::min(static_cast<std::size_t>(at), bins_.size() - 1)];
  bin.largest = bin.count == 0 ? y : std::max(bin.largest, y);
  bin.sum_x += x;
  bin.sum_y += y;
  ++bin.count;
}

void BinnedSamples::end_cycle() {
  ++cycles_;
  for (Bin& bin : bins_) {
    if (bin.count == 0) continue;
    bin.means.push_back(bin.sum_y / static_cast<double>(bin.count));
    bin.all_x += bin.sum_x;
    bin.all += bin.count;
    bin.sum_x = bin.sum_y = 0;
    bin.count = 0;
  }
}

CycleBand BinnedSamples::band() const {
  CycleBand out;
  for (const Bin& bin : bins_) {
    if (bin.means.empty() || 10 * bin.means.size() < cycles_) continue;
    std::vector<double> sorted = bin.means;
    std::sort(sorted.begin(), sorted.end());
    out.at.push_back(bin.all_x / static_cast<double>(bin.all));
    out.low.push_back(quantile_of_sorted(sorted, 0.05));
    out.middle.push_back(quantile_of_sorted(sorted, 0.5));
    out.high.push_back(quantile_of_sorted(sorted, 0.95));
  }
  return out;
}

BinExtremes BinnedSamples::extremes() const {
  BinExtremes out;
  for (const Bin& bin : bins_) {
    if (bin.count == 0) continue;
    out.at.push_back(bin.sum_x / static_cast<double>(bin.count));
    out.mean.push_back(bin.sum_y / static_cast<double>(bin.count));
    out.largest.push_back(bin.largest);
  }
  return out;
}

}  // namespace tribofit
