#include "engine/wind/judging/calibration_fit.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "engine/math/portable.hpp"

namespace yuragi::wind::judging {
namespace {

constexpr std::size_t kMinStillReadings = 10;
constexpr double kMaxStillNoise_m_s = 0.15;
constexpr double kMaxStillDrift_m_s = 0.15;
constexpr double kMaxZeroError_m_s = 2.0;

constexpr std::size_t kMinHeldReadings = 5;
constexpr double kMaxHeldSpread_deg = 5.0;
constexpr std::size_t kMinTurns = 20;
constexpr double kMaxTurnSpread_deg = 30.0;

constexpr double kMinSpan_m_s = 2.0;
constexpr double kMinGain = 0.2;
constexpr double kMaxGain = 5.0;
constexpr double kMinRSquared = 0.8;
constexpr double kBin_m_s = 1.0;
constexpr double kReach_m_s = 10.0;  // distance of the last point beyond the last bin
constexpr std::size_t kMinInBin = 3;
constexpr std::size_t kMinBins = 3;

/// A number as text, for a sentence.
std::string figure(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3).ptr;
  return {text.data(), end};
}

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// The pairs with a reading above 0: 0 stays 0 in every calibration.
std::vector<CalibrationPoint> windy(std::span<const CalibrationPoint> pairs) {
  std::vector<CalibrationPoint> some;
  for (const CalibrationPoint& pair : pairs) {
    if (pair.measured_m_s > 0.0 && std::isfinite(pair.measured_m_s) && std::isfinite(pair.true_m_s)) {
      some.push_back(pair);
    }
  }
  return some;
}

Result<void, Failure> check_span(std::span<const CalibrationPoint> pairs) {
  if (pairs.size() < 2) {
    return Failure{
        "there are " + std::to_string(pairs.size()) +
        " pairs with wind, and at least two are needed: measure longer, or find out why one of the sensors is silent"};
  }
  const auto [slow, fast] = std::ranges::minmax(pairs, {}, &CalibrationPoint::true_m_s);
  const auto [low, high] = std::ranges::minmax(pairs, {}, &CalibrationPoint::measured_m_s);
  if (fast.true_m_s - slow.true_m_s < kMinSpan_m_s) {
    return Failure{"the wind was between " + figure(slow.true_m_s) + " and " + figure(fast.true_m_s) +
                   " m/s only: a line needs " + figure(kMinSpan_m_s) +
                   " m/s between the slowest and the fastest; measure longer, or in more changeable wind"};
  }
  if (!(high.measured_m_s - low.measured_m_s > 0.0)) {
    return Failure{"the sensor said " + figure(low.measured_m_s) +
                   " m/s all the time, in whatever wind: it is stuck, or not in that wind"};
  }
  return {};
}

Result<void, Failure> check_gain(double gain) {
  if (gain >= kMinGain && gain <= kMaxGain) return {};
  if (gain <= 0.0)
    return Failure{"the sensor reads less when the reference reads more: check that both stand in the same wind"};
  return Failure{"the gain would be " + figure(gain) + ", which no sensor needs (" + figure(kMinGain) + " to " +
                 figure(kMaxGain) +
                 "): is it in this wind, and is its unit right (`unit` in [sensor.calibration], or the driver's own)?"};
}

Result<void, Failure> check_r_squared(double r_squared) {
  if (r_squared >= kMinRSquared) return {};
  return Failure{"the two sensors agree too little for a calibration (R^2 = " + figure(r_squared) + ", at least " +
                 figure(kMinRSquared) +
                 "): they are in different winds, or one lags; bring them closer together, or measure longer"};
}

/// How well `truth_of(reading)` explains the pairs.
template <class TruthOf>
void measure_fit(std::span<const CalibrationPoint> pairs, const TruthOf& truth_of, double& r_squared,
                 double& residual_m_s) {
  const auto count = static_cast<double>(pairs.size());
  double mean = 0.0;
  for (const CalibrationPoint& pair : pairs) mean += pair.true_m_s / count;
  double unexplained = 0.0;
  double all = 0.0;
  for (const CalibrationPoint& pair : pairs) {
    const double miss = pair.true_m_s - truth_of(pair.measured_m_s);
    unexplained += miss * miss;
    all += (pair.true_m_s - mean) * (pair.true_m_s - mean);
  }
  r_squared = all > 0.0 ? 1.0 - unexplained / all : 0.0;
  residual_m_s = std::sqrt(unexplained / count);
}

/// The least-squares line: about the means, so that no large numbers are subtracted from each other. There are at least
/// two different readings.
LineFit least_squares(std::span<const CalibrationPoint> pairs) {
  const auto count = static_cast<double>(pairs.size());
  CalibrationPoint mean;
  for (const CalibrationPoint& pair : pairs) {
    mean.measured_m_s += pair.measured_m_s / count;
    mean.true_m_s += pair.true_m_s / count;
  }
  double products = 0.0;
  double squares = 0.0;
  for (const CalibrationPoint& pair : pairs) {
    products += (pair.measured_m_s - mean.measured_m_s) * (pair.true_m_s - mean.true_m_s);
    squares += (pair.measured_m_s - mean.measured_m_s) * (pair.measured_m_s - mean.measured_m_s);
  }
  LineFit fit{.count = pairs.size(), .gain = products / squares};
  fit.offset_m_s = mean.true_m_s - fit.gain * mean.measured_m_s;
  return fit;
}

/// The slope of some of the pairs, limited to half and twice that of all, against scatter.
double gain_of_part(std::span<const CalibrationPoint> part, double whole_gain) {
  const double gain = part.size() >= 2 ? least_squares(part).gain : whole_gain;
  return std::isfinite(gain) ? std::clamp(gain, 0.5 * whole_gain, 2.0 * whole_gain) : whole_gain;
}

/// Pairs that are averaged together.
struct Bin {
  double measured_m_s = 0.0;  // sums
  double true_m_s = 0.0;
  std::size_t count = 0;

  CalibrationPoint mean() const {
    return {measured_m_s / static_cast<double>(count), true_m_s / static_cast<double>(count)};
  }
  void join(const Bin& other) {
    measured_m_s += other.measured_m_s;
    true_m_s += other.true_m_s;
    count += other.count;
  }
};

/// Returns true if b is to the right of a, far enough for a meaningful slope, and above it.
bool rises(const Bin& a, const Bin& b) {
  return b.mean().measured_m_s - a.mean().measured_m_s >= 0.25 * kBin_m_s &&
         b.mean().true_m_s - a.mean().true_m_s >= 0.01 * kBin_m_s;
}

/// Adds a point at either end, because a curve is extrapolated from its last two points, and two bins can have any
/// slope: with the slope of the slower half of the pairs down to 0, and of the faster half up.
void extend(std::vector<CalibrationPoint>& curve, std::vector<CalibrationPoint>& pairs, double whole_gain) {
  std::ranges::sort(pairs, {}, &CalibrationPoint::measured_m_s);
  const std::size_t half = pairs.size() / 2;
  const double low_gain = gain_of_part(std::span(pairs).first(half), whole_gain);
  const double high_gain = gain_of_part(std::span(pairs).subspan(half), whole_gain);

  const CalibrationPoint first = curve.front();
  const double at_zero_m_s = first.true_m_s - low_gain * first.measured_m_s;
  const CalibrationPoint low = at_zero_m_s >= 0.0
                                   ? CalibrationPoint{0.0, at_zero_m_s}
                                   : CalibrationPoint{first.measured_m_s - first.true_m_s / low_gain, 0.0};
  if (first.measured_m_s - low.measured_m_s >= 0.25 * kBin_m_s) curve.insert(curve.begin(), low);
  const CalibrationPoint last = curve.back();
  curve.push_back({last.measured_m_s + kReach_m_s, last.true_m_s + high_gain * kReach_m_s});
}

}  // namespace

Result<StillAir, Failure> measure_still_air(std::span<const double> indicated_m_s) {
  StillAir air{.count = indicated_m_s.size(), .mean_m_s = mean_of(indicated_m_s)};
  if (air.count < kMinStillReadings) {
    return Failure{"only " + std::to_string(air.count) + " readings came, and " + std::to_string(kMinStillReadings) +
                   " are the least: measure longer with --for"};
  }
  double squares = 0.0;
  for (const double value : indicated_m_s) squares += (value - air.mean_m_s) * (value - air.mean_m_s);
  air.noise_m_s = std::sqrt(squares / static_cast<double>(air.count - 1));

  // Moving air shows in the scatter, air that is coming to rest in the difference of the two halves.
  const double drift_m_s =
      mean_of(indicated_m_s.subspan(air.count / 2)) - mean_of(indicated_m_s.subspan(0, air.count - air.count / 2));
  const bool is_calm = air.noise_m_s <= kMaxStillNoise_m_s && std::abs(drift_m_s) <= kMaxStillDrift_m_s;
  if (!is_calm) {
    return Failure{"the air is not still: the readings scatter by " + figure(air.noise_m_s) + " m/s and drift by " +
                   figure(drift_m_s) + " m/s (at most " + figure(kMaxStillNoise_m_s) +
                   " each); put a box or a bag over the sensor and close the windows"};
  }
  if (air.mean_m_s > kMaxZeroError_m_s) {
    return Failure{"a steady " + figure(air.mean_m_s) +
                   " m/s is a wind or a fault, not a zero error: a zero error is below " + figure(kMaxZeroError_m_s) +
                   " m/s; cover the sensor, and check its unit and its wiring"};
  }
  return air;
}

double offset_for_zero_m_s(const Calibration& calibration, double still_m_s) noexcept {
  return calibration.offset_m_s + calibration.gain * (zero_point_m_s(calibration) - still_m_s);
}

DirectionMean direction_mean(std::span<const double> directions_deg) noexcept {
  if (directions_deg.empty()) return {};
  constexpr double kRadians = std::numbers::pi / 180.0;
  double east = 0.0;
  double north = 0.0;
  for (const double direction_deg : directions_deg) {
    east += std::sin(kRadians * direction_deg);
    north += std::cos(kRadians * direction_deg);
  }
  const double length = std::min(1.0, math::length(east, north) / static_cast<double>(directions_deg.size()));
  double mean_deg = std::atan2(east, north) / kRadians;
  if (mean_deg < 0.0) mean_deg += 360.0;
  return {.count = directions_deg.size(),
          .mean_deg = mean_deg < 360.0 ? mean_deg : 0.0,
          .spread_deg =
              length > 0.0 ? std::sqrt(-2.0 * std::log(length)) / kRadians : std::numeric_limits<double>::infinity()};
}

Result<DirectionMean, Failure> measure_held_vane(std::span<const double> indicated_deg) {
  const DirectionMean mean = direction_mean(indicated_deg);
  if (mean.count < kMinHeldReadings) {
    return Failure{"only " + std::to_string(mean.count) + " directions came, and " + std::to_string(kMinHeldReadings) +
                   " are the least: does this sensor have a vane? If so measure longer with --for"};
  }
  if (mean.spread_deg > kMaxHeldSpread_deg) {
    return Failure{"the vane moved: its directions scatter by " + figure(mean.spread_deg) + " degrees (at most " +
                   figure(kMaxHeldSpread_deg) + "); hold it, or tie it, and measure again"};
  }
  return mean;
}

Result<DirectionMean, Failure> measure_turn(std::span<const double> turns_deg) {
  const DirectionMean mean = direction_mean(turns_deg);
  if (mean.count < kMinTurns) {
    return Failure{"only " + std::to_string(mean.count) + " pairs of directions with wind came, and " +
                   std::to_string(kMinTurns) +
                   " are the least: measure longer with --for, when there is more than 1 m/s of wind"};
  }
  if (mean.spread_deg > kMaxTurnSpread_deg) {
    return Failure{"the two vanes do not turn together: the angle between them scatters by " + figure(mean.spread_deg) +
                   " degrees (at most " + figure(kMaxTurnSpread_deg) +
                   "); are they in the same wind, and is neither stuck or sheltered?"};
  }
  return mean;
}

std::vector<double> pair_turns(std::span<const TimedDirection> indicated, std::span<const TimedDirection> truth,
                               double block_s) {
  struct Block {
    std::vector<double> indicated_deg, true_deg;
  };
  std::map<std::int64_t, Block> blocks;
  const auto number_of = [block_s](double time_s) { return static_cast<std::int64_t>(std::floor(time_s / block_s)); };
  for (const TimedDirection& one : indicated) blocks[number_of(one.time_s)].indicated_deg.push_back(one.direction_deg);
  for (const TimedDirection& one : truth) blocks[number_of(one.time_s)].true_deg.push_back(one.direction_deg);
  std::vector<double> turns_deg;
  for (const auto& [number, block] : blocks) {
    if (block.indicated_deg.empty() || block.true_deg.empty()) continue;
    turns_deg.push_back(
        signed_degrees(direction_mean(block.true_deg).mean_deg - direction_mean(block.indicated_deg).mean_deg));
  }
  return turns_deg;
}

double signed_degrees(double angle_deg) noexcept {
  const double turned_deg = std::remainder(angle_deg, 360.0);
  return turned_deg <= -180.0 ? 180.0 : turned_deg;
}

Result<LineFit, Failure> fit_line(std::span<const CalibrationPoint> pairs) {
  const std::vector<CalibrationPoint> some = windy(pairs);
  if (auto enough = check_span(some); !enough) return enough.error();

  LineFit fit = least_squares(some);
  measure_fit(
      some, [&fit](double indicated_m_s) { return fit.gain * indicated_m_s + fit.offset_m_s; }, fit.r_squared,
      fit.residual_m_s);
  if (auto agrees = check_r_squared(fit.r_squared); !agrees) return agrees.error();
  if (auto possible = check_gain(fit.gain); !possible) return possible.error();
  return fit;
}

Result<LineFit, Failure> fit_line_from_zero(double zero_m_s, const CalibrationPoint& pair) {
  if (pair.true_m_s < kMinSpan_m_s) {
    return Failure{"a known wind of " + figure(pair.true_m_s) + " m/s is too slow to find a gain with; use at least " +
                   figure(kMinSpan_m_s) + " m/s"};
  }
  if (!(pair.measured_m_s > std::max(0.0, zero_m_s))) {
    return Failure{"the sensor measured no wind (it read " + figure(pair.measured_m_s) + " m/s, its zero is at " +
                   figure(zero_m_s) + "): is it in this wind, and does it turn freely?"};
  }
  const double gain = pair.true_m_s / (pair.measured_m_s - zero_m_s);
  if (auto possible = check_gain(gain); !possible) return possible.error();
  return LineFit{.count = 1, .gain = gain, .offset_m_s = -gain * zero_m_s};
}

Result<CurveFit, Failure> fit_curve(std::span<const CalibrationPoint> pairs) {
  std::vector<CalibrationPoint> some = windy(pairs);
  const auto line = fit_line(some);
  if (!line) return line.error();

  std::map<std::int64_t, Bin> by_speed;
  for (const CalibrationPoint& pair : some) {
    by_speed[static_cast<std::int64_t>(std::floor(pair.measured_m_s / kBin_m_s))].join(
        {pair.measured_m_s, pair.true_m_s, 1});
  }
  // Pool adjacent violators: a bin that does not rise above the one before is joined to it, and that to the one before.
  std::vector<Bin> bins;
  for (const auto& [speed, bin] : by_speed) {
    if (bin.count < kMinInBin) continue;
    bins.push_back(bin);
    while (bins.size() > 1 && !rises(bins[bins.size() - 2], bins.back())) {
      bins[bins.size() - 2].join(bins.back());
      bins.pop_back();
    }
  }
  if (bins.size() < kMinBins) {
    return Failure{"a curve needs wind in " + std::to_string(kMinBins) + " bins of 1 m/s, with " +
                   std::to_string(kMinInBin) + " means in each, and there are " + std::to_string(bins.size()) +
                   ": measure longer, or take a line (leave out --curve)"};
  }
  CurveFit fit;
  for (const Bin& bin : bins) fit.curve.push_back(bin.mean());
  extend(fit.curve, some, line->gain);
  const Calibration calibration{.curve = fit.curve};
  measure_fit(
      some,
      [&calibration](double indicated_m_s) {
        Reading indicated;
        indicated.speed_m_s = indicated_m_s;
        return calibration.applied_to(indicated).speed_m_s;
      },
      fit.r_squared, fit.residual_m_s);
  return fit;
}

std::vector<CalibrationPoint> pair_means(std::span<const TimedSpeed> indicated, std::span<const TimedSpeed> truth,
                                         double block_s) {
  struct Block {
    double indicated_m_s = 0.0, true_m_s = 0.0;  // sums
    std::size_t indicated_count = 0, true_count = 0;
  };
  std::map<std::int64_t, Block> blocks;
  const auto block_at = [&](double time_s) -> Block& {
    return blocks[static_cast<std::int64_t>(std::floor(time_s / block_s))];
  };
  for (const TimedSpeed& one : indicated) {
    Block& block = block_at(one.time_s);
    block.indicated_m_s += one.speed_m_s;
    ++block.indicated_count;
  }
  for (const TimedSpeed& one : truth) {
    Block& block = block_at(one.time_s);
    block.true_m_s += one.speed_m_s;
    ++block.true_count;
  }
  std::vector<CalibrationPoint> pairs;
  for (const auto& [number, block] : blocks) {
    if (block.indicated_count == 0 || block.true_count == 0) continue;
    pairs.push_back({block.indicated_m_s / static_cast<double>(block.indicated_count),
                     block.true_m_s / static_cast<double>(block.true_count)});
  }
  return pairs;
}

}  // namespace yuragi::wind::judging
