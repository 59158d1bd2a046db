#pragma once

#include <cstddef>
#include <vector>

namespace tribofit {

/// A quantity over another, in bins, as its spread over cycles.
struct CycleBand {
  std::vector<double> at;                 ///< mean of the abscissa in the bin
  std::vector<double> low, middle, high;  ///< 5 %, 50 % and 95 % quantile over cycles of the mean in a cycle and bin
};

/// Mean and largest value of samples in bins, without the bins that hold none.
struct BinExtremes {
  std::vector<double> at;             ///< mean of the abscissa in the bin
  std::vector<double> mean, largest;  ///< of the ordinate
};

/// Collects samples into bins of equal width from `from` to `to`, cycle by cycle.
class BinnedSamples {
 public:
  BinnedSamples(double from, double to, std::size_t bins);
  /// A sample of the present cycle; what lies outside or has no finite ordinate is left out. What lies on the upper end
  /// belongs to the last bin.
  void add(double x, double y);
  /// The samples that follow belong to another cycle.
  void end_cycle();
  /// Bins that at least a tenth of the cycles reach.
  CycleBand band() const;
  /// What a typical and what the worst sample of the present cycle does.
  BinExtremes extremes() const;

 private:
  struct Bin {
    double sum_x = 0, sum_y = 0, largest = 0;  ///< of the present cycle
    std::size_t count = 0;
    double all_x = 0;
    std::size_t all = 0;
    std::vector<double> means;  ///< of y in each cycle before
  };
  double from_, width_;
  std::vector<Bin> bins_;
  std::size_t cycles_ = 0;
};

}  // namespace tribofit
