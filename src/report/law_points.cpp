#include "law_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "drawing.hpp"
#include "numbers.hpp"
#include "page_series.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kSpeedBins = 48, kErrorBins = 80, kTimeBins = 400;
/// Rows and columns of the map of residuals.
constexpr std::size_t kMapRows = 120, kMapColumns = 50;
constexpr std::size_t kFewestPieces = 20;

/// A part of a slip in which the speed only rises or only falls; both where the block never sticks.
enum class Branch { accelerating, decelerating, both };
constexpr std::array<std::string_view, 3> kBranchNames = {"speeding up", "slowing down", "slip"};

/// A slip cut at its fastest sample. Slips that never stop are cut into pieces instead, which stand for cycles.
struct Piece {
  Branch branch;
  std::size_t begin, end;
  int direction;
  bool ends_cycle;
};

std::vector<Piece> pieces_of(const Identification& trace) {
  std::vector<Piece> pieces;
  const Segmentation& s = trace.segmentation;
  const std::vector<double>& v = trace.motion.relative_velocity;
  for (const Cycle& c : s.cycles) {
    const std::size_t end = std::min(c.slip.end, v.size());
    if (c.slip.begin >= end) continue;
    if (s.kind == MotionKind::always_slipping) {
      const std::size_t n = end - c.slip.begin, count = std::min(n, kFewestPieces);
      for (std::size_t k = 0; k < count; ++k) {
        pieces.push_back(
            {Branch::both, c.slip.begin + n * k / count, c.slip.begin + n * (k + 1) / count, c.direction, true});
      }
      continue;
    }
    const auto first = v.begin() + static_cast<std::ptrdiff_t>(c.slip.begin);
    const auto last = v.begin() + static_cast<std::ptrdiff_t>(end);
    const auto fastest = std::max_element(first, last, [](double a, double b) { return std::abs(a) < std::abs(b); });
    const auto peak = static_cast<std::size_t>(fastest - v.begin());
    pieces.push_back({Branch::accelerating, c.slip.begin, peak, c.direction, false});
    pieces.push_back({Branch::decelerating, peak, end, c.direction, true});
  }
  return pieces;
}

double fastest_of(const Identification& trace, const std::vector<Piece>& pieces) {
  double fastest = 0;
  for (const Piece& piece : pieces) {
    for (std::size_t i = piece.begin; i < piece.end; ++i) {
      fastest = std::max(fastest, std::abs(trace.motion.relative_velocity[i]));
    }
  }
  return fastest / kMillimetre;
}

/// Bands of value(sample, direction) over speed, one for each branch that there is.
template <class Value>
Json bands_json(const Identification& trace, const std::vector<Piece>& pieces, double fastest, Value value) {
  std::vector<BandOverCycles> bands(kBranchNames.size(), BandOverCycles(0, fastest, kSpeedBins));
  for (const Piece& piece : pieces) {
    BandOverCycles& band = bands[static_cast<std::size_t>(piece.branch)];
    for (std::size_t i = piece.begin; i < piece.end; ++i) {
      band.add(std::abs(trace.motion.relative_velocity[i]) / kMillimetre, value(i, piece.direction));
    }
    band.end_cycle();
  }
  Json list = Json::array();
  for (std::size_t k = 0; k < bands.size(); ++k) {
    const DrawnBand band = bands[k].band();
    if (band.at.empty()) continue;
    list.push_back({{"branch", kBranchNames[k]},
                    {"v", numbers_json(band.at)},
                    {"low", numbers_json(band.low)},
                    {"middle", numbers_json(band.middle)},
                    {"high", numbers_json(band.high)}});
  }
  return list;
}

Json extremes_json(const DrawnExtremes& extremes) {
  return {{"x", numbers_json(extremes.at)},
          {"mean", numbers_json(extremes.mean)},
          {"largest", numbers_json(extremes.largest)}};
}

/// Relative error ([D] Eq 5) over speed and time.
Json errors_json(const Identification& trace, const std::vector<Piece>& pieces, double fastest,
                 const std::vector<double>& prediction) {
  const Motion& m = trace.motion;
  ExtremesInBins over_speed(0, fastest, kErrorBins), over_time(m.time.front(), m.time.back(), kTimeBins);
  for (const Piece& piece : pieces) {
    for (std::size_t i = piece.begin; i < piece.end; ++i) {
      const double error = std::abs((m.friction[i] - prediction[i]) / m.friction[i]);
      over_speed.add(std::abs(m.relative_velocity[i]) / kMillimetre, error);
      over_time.add(m.time[i], error);
    }
  }
  return {{"over_speed", extremes_json(over_speed.result())}, {"over_time", extremes_json(over_time.result())}};
}

/// Mean residual in units of the floor over cycles (neighbours together where there are many) and the phase of the
/// slip, from break-away (0) to re-stick (1).
Json map_json(const Identification& trace, const std::vector<double>& prediction, double floor) {
  const std::vector<Cycle>& cycles = trace.segmentation.cycles;
  if (trace.segmentation.kind != MotionKind::stick_slip || cycles.empty()) return nullptr;
  const std::size_t rows = std::min(kMapRows, cycles.size());
  std::vector<std::vector<double>> sum(rows, std::vector<double>(kMapColumns, 0.0)), count = sum;
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    const Cycle& cycle = cycles[c];
    if (!cycle.slip_complete) continue;
    const std::size_t row = c * rows / cycles.size();
    for (std::size_t i = cycle.slip.begin; i < std::min(cycle.slip.end, prediction.size()); ++i) {
      const double phase = static_cast<double>(i - cycle.slip.begin) / static_cast<double>(cycle.slip.size());
      const auto column = std::min(kMapColumns - 1, static_cast<std::size_t>(phase * static_cast<double>(kMapColumns)));
      if (!std::isfinite(prediction[i])) continue;
      sum[row][column] += cycle.direction * (trace.motion.friction[i] - prediction[i]) / floor;
      count[row][column] += 1;
    }
  }
  Json z = Json::array(), first = Json::array(), phase = Json::array();
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < kMapColumns; ++k) sum[row][k] /= count[row][k];  // NaN where nothing is: left white
    z.push_back(numbers_json(sum[row], 3));
    first.push_back((row * cycles.size() + rows - 1) / rows);
  }
  for (std::size_t k = 0; k < kMapColumns; ++k) {
    phase.push_back(rounded((static_cast<double>(k) + 0.5) / static_cast<double>(kMapColumns)));
  }
  return {{"cycle", std::move(first)}, {"phase", std::move(phase)}, {"residual", std::move(z)}};
}

/// What residuals are measured in: the floor, or what they are themselves where none is known.
double unit_of(const Fit& fit) {
  if (fit.floor.rmse > 0) return fit.floor.rmse;
  return fit.error.rmse > 0 ? fit.error.rmse : 1;
}

}  // namespace

void add_law_points(const Identification& trace, const std::vector<std::vector<double>>& predictions,
                    const std::vector<DrawnModel>& models, Json& json) {
  const std::vector<Piece> pieces = pieces_of(trace);
  const double fastest = fastest_of(trace, pieces);
  if (!(fastest > 0)) return;
  const std::vector<double>& friction = trace.motion.friction;
  json["branches"] = bands_json(trace, pieces, fastest, [&](std::size_t i, int sign) { return sign * friction[i]; });
  json["residuals"] = json["errors"] = Json::array();
  for (std::size_t m = 0; m < models.size(); ++m) {
    const std::vector<double>& prediction = predictions[m];
    const double unit = unit_of(*models[m].fit);
    json["residuals"].push_back(bands_json(
        trace, pieces, fastest, [&](std::size_t i, int sign) { return sign * (friction[i] - prediction[i]) / unit; }));
    json["errors"].push_back(errors_json(trace, pieces, fastest, prediction));
  }
  if (!models.empty()) json["map"] = map_json(trace, predictions[0], unit_of(*models[0].fit));
}

}  // namespace tribofit
