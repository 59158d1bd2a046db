// Frequency and amplitude of known lines, between the bins.
#include "tribofit/statistics/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

#include "../kinematics/stick_slip_truth.hpp"

namespace tribofit {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

std::vector<double> sine(std::size_t n, double step, double frequency, double amplitude, double mean = 0) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i)
    x[i] = mean + amplitude * std::sin(two_pi * frequency * step * static_cast<double>(i) + 0.7);
  return x;
}

TEST(Spectrum, AmplitudeOfASineOnABin) {
  const double step = 1e-3;
  const Spectrum s = amplitude_spectrum(sine(4000, step, 25, 3, 10), step);
  EXPECT_NEAR(s.bin_width, 0.25, 1e-12);
  EXPECT_NEAR(s.amplitude[100], 3, 1e-3);
  EXPECT_NEAR(s.amplitude[101], 1.5, 1e-3);  // Hann: half in the neighbours
  EXPECT_NEAR(s.amplitude[0], 0, 1e-3);
}

TEST(Spectrum, LongOnesAreTheSumsThatDefineThem) {
  // None is padded: no length has a prime factor above five.
  for (const std::size_t n : {40000u, 37500u, 33750u}) {
    std::vector<double> signal(n);
    std::uint32_t state = 1;
    double mean = 0;
    for (double& x : signal) {
      x = static_cast<double>(state = 1664525 * state + 1013904223) / 4294967296.0;
      mean += x / static_cast<double>(n);
    }
    const Spectrum s = amplitude_spectrum(signal, 1);
    ASSERT_EQ(s.amplitude.size(), n / 2 + 1);
    for (const std::size_t k : {std::size_t{1}, n / 50, n / 4 - 1, n / 4, n / 4 + 1, n / 3, n / 2 - 1, n / 2}) {
      std::complex<double> sum = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const double turn = two_pi * static_cast<double>(i) / static_cast<double>(n);
        sum += std::pow(std::sin(turn / 2), 2) * (signal[i] - mean) * std::polar(1.0, -turn * static_cast<double>(k));
      }
      EXPECT_NEAR(s.amplitude[k], 4 * std::abs(sum) / static_cast<double>(n), 1e-12) << n << " " << k;
    }
  }
}

TEST(Spectrum, UpToAFrequencyItIsThatOfTheWhole) {
  const double step = 1e-4;
  const std::vector<double> signal = sine(40000, step, 22.5, 3, 0);  // four seconds: on a bin
  const Spectrum s = spectrum_up_to(signal, step, 25);
  ASSERT_GT(s.amplitude.size(), 0u);
  EXPECT_NEAR(static_cast<double>(s.amplitude.size() - 1) * s.bin_width, 25, s.bin_width);
  EXPECT_NEAR(peak_frequency(s, 1, 25), 22.5, 0.1 * s.bin_width);
  EXPECT_NEAR(*std::max_element(s.amplitude.begin(), s.amplitude.end()), 3, 0.02) << "also next to the end";
  EXPECT_TRUE(spectrum_up_to(signal, step, 0).amplitude.empty());
}

TEST(Spectrum, AwkwardLengthsAreNoTrouble) {
  for (std::size_t n : {4u, 5u, 7u, 997u, 10007u}) {
    const Spectrum s = amplitude_spectrum(sine(n, 0.01, 5, 1), 0.01);
    EXPECT_GE(s.amplitude.size(), n / 2);
  }
  EXPECT_TRUE(amplitude_spectrum({}, 1).amplitude.empty());
  EXPECT_EQ(fundamental(std::vector<double>(2, 1.0), 1).frequency, 0);
}

TEST(Spectrum, FundamentalBetweenBinsOfAShortAndALongRecord) {
  for (double seconds : {2.0, 20.0, 120.0}) {
    for (double f : {4.8831, 5.31, 37.77}) {
      const double step = 5e-5;
      const auto n = static_cast<std::size_t>(seconds / step);
      const SpectralPeak peak = fundamental(sine(n, step, f, 2.64), step);
      EXPECT_NEAR(peak.frequency, f, 0.003 / seconds) << seconds;
      EXPECT_NEAR(peak.amplitude, 2.64, 0.01);
      EXPECT_NEAR(peak.bin_width, 0.6103515625, 1e-9);
      EXPECT_LE(std::abs(peak.bin_frequency - f), 0.5 * peak.bin_width + 1e-9);
    }
  }
}

TEST(Spectrum, LineAboveTheReducedBandIsStillFound) {
  const double step = 5e-5, f = 1234.5;
  EXPECT_NEAR(fundamental(sine(2400000, step, f, 1), step).frequency, f, 1e-3);
}

TEST(Spectrum, TheBinsOfThePublishedTable) {
  // [D] reports 3.662, 4.272, 4.883, 5.493 Hz: bins 6 to 9 of 32768 samples at 20 kHz.
  const double published[] = {3.662, 4.272, 4.883, 5.493};
  for (int k = 0; k < 4; ++k) {
    const SpectralPeak peak = fundamental(sine(400000, 5e-5, published[k] + 0.2, 1), 5e-5);
    EXPECT_NEAR(peak.bin_frequency, published[k], 5e-4);
  }
}

TEST(Spectrum, PulsesWhoseSecondHarmonicIsLargerKeepTheirFundamental) {
  const double step = 1e-3;
  std::vector<double> x = sine(40000, step, 4.3, 1);
  const std::vector<double> second = sine(40000, step, 8.6, 1.3);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += second[i];
  EXPECT_NEAR(fundamental(x, step).frequency, 4.3, 1e-3);
}

TEST(Spectrum, StickSlipFrequencyAgreesWithTheEvents) {
  truth::Rig rig;
  rig.duration = 20;
  const truth::Run run = truth::simulate(rig);
  const auto n = static_cast<double>(run.break_away_time.size() - 1);
  const double events = n / (run.break_away_time.back() - run.break_away_time.front());
  EXPECT_NEAR(fundamental(run.trace.velocity, 1 / rig.rate).frequency, events, 0.002);
}

TEST(ProductsAtEveryLag, AreSumsOfProducts) {
  const std::vector<double> x = {1, -2, 3, 0.5, 7}, y = {2, 4, -1};
  const std::vector<double> products = products_at_every_lag(x, y);
  ASSERT_EQ(products.size(), x.size() + y.size() - 1);
  for (int lag = -2; lag < 5; ++lag) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      if (i + lag >= 0 && i + lag < 5) sum += x[static_cast<std::size_t>(i + lag)] * y[static_cast<std::size_t>(i)];
    }
    EXPECT_NEAR(products[static_cast<std::size_t>(lag + 2)], sum, 1e-12) << lag;
  }
}

}  // namespace
}  // namespace tribofit
