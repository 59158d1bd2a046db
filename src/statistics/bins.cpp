#include "tribofit/statistics/bins.hpp"

#include <algorithm>
#include <cmath>

#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kNoBin = static_cast<std::size_t>(-1);

/// Index of the bin of x among `count`; none outside. What lies on the upper end belongs to the last bin.
std::size_t bin_of(double x, double from, double width, std::size_t count) {
  const double at = (x - from) / width;
  if (!(at >= 0) || !(at <= static_cast<double>(count))) return kNoBin;
  return std::min(static_cast<std::size_t>(at), count - 1);
}

}  // namespace

BandOverCycles::BandOverCycles(double from, double to, std::size_t bins)
    : from_(from), width_((to - from) / static_cast<double>(bins)), bins_(bins) {}

void BandOverCycles::add(double x, double y) {
  const std::size_t k = bin_of(x, from_, width_, bins_.size());
  if (k == kNoBin || !std::isfinite(y)) return;
  Bin& bin = bins_[k];
  bin.sum_x += x;
  bin.sum_y += y;
  ++bin.count;
}

void BandOverCycles::end_cycle() {
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

CycleBand BandOverCycles::band() const {
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

ExtremesInBins::ExtremesInBins(double from, double to, std::size_t bins)
    : from_(from), width_((to - from) / static_cast<double>(bins)), bins_(bins) {}

void ExtremesInBins::add(double x, double y) {
  const std::size_t k = bin_of(x, from_, width_, bins_.size());
  if (k == kNoBin || !std::isfinite(y)) return;
  Bin& bin = bins_[k];
  bin.largest = bin.count == 0 ? y : std::max(bin.largest, y);
  bin.sum_x += x;
  bin.sum_y += y;
  ++bin.count;
}

BinExtremes ExtremesInBins::result() const {
  BinExtremes out;
  for (const Bin& bin : bins_) {
    if (bin.count == 0) continue;
    const double count = static_cast<double>(bin.count);
    out.at.push_back(bin.sum_x / count);
    out.mean.push_back(bin.sum_y / count);
    out.largest.push_back(bin.largest);
  }
  return out;
}

}  // namespace tribofit
