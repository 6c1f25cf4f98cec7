#include "drivers/decode/microphone/mic_calibration.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::decode::microphone {
namespace {

constexpr std::size_t kMinPairs = 8;
constexpr double kMinSpan_m_s = 1.0;
constexpr double kMinSpan_db = 3.0;
constexpr double kMinExponent = 0.3;
constexpr double kMaxExponent = 6.0;
constexpr int kExponentSteps = 400;
constexpr int kCurvePoints = 17;
constexpr double kSilence_db = -200.0;
constexpr double kClearlyBetter = 0.9;

using Pairs = std::span<const MicLevelAndSpeed>;

double power_of_db(double level_db) {
  return std::pow(10.0, 0.1 * level_db);
}

double curve_speed(const MicCurve& curve, double level_db) {
  const auto& points = curve.points;
  if (points.empty()) return 0.0;
  if (points.size() == 1 || level_db <= points.front().level_db) return points.front().speed_m_s;
  // The segment that contains the level; the last one for higher levels.
  auto upper = std::ranges::lower_bound(points, level_db, {}, &MicLevelAndSpeed::level_db);
  if (upper == points.end()) --upper;
  const auto lower = upper - 1;
  const double slope = (upper->speed_m_s - lower->speed_m_s) / (upper->level_db - lower->level_db);
  return lower->speed_m_s + slope * (level_db - lower->level_db);
}

std::optional<Failure> too_little(Pairs pairs) {
  if (pairs.size() < kMinPairs) {
    return Failure{"too few pairs of level and speed: at least " + std::to_string(kMinPairs) + " are needed"};
  }
  const auto finite = [](const MicLevelAndSpeed& pair) {
    return std::isfinite(pair.level_db) && std::isfinite(pair.speed_m_s);
  };
  if (!std::ranges::all_of(pairs, finite)) return Failure{"a level or a speed is not a number"};
  const auto [softest, loudest] = std::ranges::minmax(pairs, {}, &MicLevelAndSpeed::level_db);
  const auto [slowest, fastest] = std::ranges::minmax(pairs, {}, &MicLevelAndSpeed::speed_m_s);
  if (fastest.speed_m_s - slowest.speed_m_s < kMinSpan_m_s || loudest.level_db - softest.level_db < kMinSpan_db) {
    return Failure{"the wind varied too little for a calibration: both calm and wind are needed"};
  }
  return std::nullopt;
}

/// Least squares of a parabola c0 + c1 x + c2 x^2, with x the level about its mean and in tens of dB.
struct Parabola {
  double centre_db = 0.0;
  std::array<double, 3> c{};

  double at(double level_db) const {
    const double x = (level_db - centre_db) / 10.0;
    return c[0] + x * (c[1] + x * c[2]);
  }
};

Parabola fit_parabola(Pairs pairs) {
  Parabola parabola;
  for (const auto& pair : pairs) parabola.centre_db += pair.level_db / static_cast<double>(pairs.size());

  // Normal equations, solved by elimination; well conditioned because centred and scaled.
  std::array<std::array<double, 4>, 3> rows{};
  for (const auto& pair : pairs) {
    const double x = (pair.level_db - parabola.centre_db) / 10.0;
    const std::array<double, 3> basis = {1.0, x, x * x};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) rows[i][j] += basis[i] * basis[j];
      rows[i][3] += basis[i] * pair.speed_m_s;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    rows[i][i] += 1e-9;  // so that two levels give a line, and no division by zero
    for (std::size_t j = i + 1; j < 3; ++j) {
      const double factor = rows[j][i] / rows[i][i];
      for (std::size_t k = i; k < 4; ++k) rows[j][k] -= factor * rows[i][k];
    }
  }
  for (std::size_t i = 3; i-- > 0;) {
    double sum = rows[i][3];
    for (std::size_t j = i + 1; j < 3; ++j) sum -= rows[i][j] * parabola.c[j];
    parabola.c[i] = sum / rows[i][i];
  }
  return parabola;
}

double mean_error(const MicCalibration& calibration, double noise_power, Pairs pairs) {
  double sum = 0.0;
  for (const auto& pair : pairs) {
    sum += std::abs(mic_speed_m_s(calibration, power_of_db(pair.level_db), noise_power) - pair.speed_m_s);
  }
  return sum / static_cast<double>(pairs.size());
}

/// A number at the front of the text, which is taken off.
std::optional<double> take_number(std::string_view& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

}  // namespace

double mic_speed_m_s(const MicCalibration& calibration, double power, double noise_power) noexcept {
  double speed_m_s = 0.0;
  if (const auto* law = std::get_if<MicPowerLaw>(&calibration)) {
    const double wind_power = std::max(0.0, power - noise_power);
    speed_m_s = law->gain_m_s * std::pow(wind_power, 0.5 / law->exponent);
  } else {
    const double level_db = power > 0.0 ? std::max(kSilence_db, 10.0 * std::log10(power)) : kSilence_db;
    speed_m_s = curve_speed(std::get<MicCurve>(calibration), level_db);
  }
  return std::clamp(speed_m_s, 0.0, wind::kMaxPlausibleSpeed_m_s);
}

std::optional<double> mic_level_db(const MicCalibration& calibration, double speed_m_s, double noise_power) noexcept {
  if (const auto* law = std::get_if<MicPowerLaw>(&calibration)) {
    if (!(speed_m_s > 0.0)) return std::nullopt;
    return 10.0 * std::log10(std::pow(speed_m_s / law->gain_m_s, 2.0 * law->exponent) + noise_power);
  }
  // The segment that rises through the speed; the last one for higher speeds.
  const auto& points = std::get<MicCurve>(calibration).points;
  for (std::size_t upper = 1; upper < points.size(); ++upper) {
    const MicLevelAndSpeed& a = points[upper - 1];
    const MicLevelAndSpeed& b = points[upper];
    const bool holds = speed_m_s > a.speed_m_s && (speed_m_s <= b.speed_m_s || upper + 1 == points.size());
    if (!holds || !(b.speed_m_s > a.speed_m_s)) continue;
    return a.level_db + (speed_m_s - a.speed_m_s) * (b.level_db - a.level_db) / (b.speed_m_s - a.speed_m_s);
  }
  return std::nullopt;
}

Result<MicCurve, Failure> parse_mic_curve(std::string_view text) {
  const Failure malformed{"a microphone's curve is written as points dB:m/s, such as \"-62:0 -50:1.2 -40:3.4\""};
  MicCurve curve;
  while (true) {
    while (!text.empty() && (text.front() == ' ' || text.front() == ',')) text.remove_prefix(1);
    if (text.empty()) break;
    const auto level_db = take_number(text);
    if (!level_db || text.empty() || text.front() != ':') return malformed;
    text.remove_prefix(1);
    const auto speed_m_s = take_number(text);
    if (!speed_m_s) return malformed;
    curve.points.push_back({*level_db, *speed_m_s});
  }
  if (curve.points.size() < 2) return malformed;

  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const MicLevelAndSpeed& point = curve.points[i];
    if (point.speed_m_s < 0.0 || point.speed_m_s > wind::kMaxPlausibleSpeed_m_s) {
      return Failure{"a microphone's curve has an impossible speed"};
    }
    if (i > 0 && (point.level_db <= curve.points[i - 1].level_db || point.speed_m_s < curve.points[i - 1].speed_m_s)) {
      return Failure{"the levels of a microphone's curve must rise, and its speeds must not fall"};
    }
  }
  return curve;
}

std::string format_mic_curve(const MicCurve& curve) {
  std::string text;
  for (const auto& point : curve.points) {
    std::array<char, 64> words{};
    std::snprintf(words.data(), words.size(), "%s%.2f:%.3f", text.empty() ? "" : " ", point.level_db, point.speed_m_s);
    text += words.data();
  }
  return text;
}

Result<MicPowerLaw, Failure> fit_mic_power_law(Pairs pairs, double noise_power) {
  if (auto failure = too_little(pairs)) return *failure;

  // For each exponent the best gain is a quotient of sums; the exponents are tried one by one.
  std::optional<MicPowerLaw> best;
  double least_squares = 0.0;
  for (int step = 0; step <= kExponentSteps; ++step) {
    const double exponent =
        kMinExponent * std::pow(kMaxExponent / kMinExponent, static_cast<double>(step) / kExponentSteps);
    double products = 0.0;
    double squares = 0.0;
    double speeds = 0.0;
    for (const auto& pair : pairs) {
      const double root = std::pow(std::max(0.0, power_of_db(pair.level_db) - noise_power), 0.5 / exponent);
      products += root * pair.speed_m_s;
      squares += root * root;
      speeds += pair.speed_m_s * pair.speed_m_s;
    }
    if (!(squares > 0.0) || !(products > 0.0)) continue;
    const double error = speeds - products * products / squares;
    if (!best || error < least_squares) {
      best = MicPowerLaw{products / squares, exponent};
      least_squares = error;
    }
  }
  if (!best) return Failure{"no pair is louder than the noise in a calm: record stronger wind, too"};
  return *best;
}

Result<MicCurve, Failure> fit_mic_curve(Pairs pairs) {
  if (auto failure = too_little(pairs)) return *failure;
  const Parabola parabola = fit_parabola(pairs);
  const auto [softest, loudest] = std::ranges::minmax(pairs, {}, &MicLevelAndSpeed::level_db);

  // Sampled from the side on which it rises: from its turning point on it is level.
  const double turn_db =
      parabola.c[2] == 0.0 ? softest.level_db - 1.0 : parabola.centre_db - 10.0 * 0.5 * parabola.c[1] / parabola.c[2];
  const bool opens_upward = parabola.c[2] > 0.0;
  MicCurve curve;
  double highest_m_s = 0.0;
  for (int i = 0; i < kCurvePoints; ++i) {
    const double level_db =
        softest.level_db + (loudest.level_db - softest.level_db) * static_cast<double>(i) / (kCurvePoints - 1);
    const double held_db = opens_upward          ? std::max(level_db, turn_db)
                           : parabola.c[2] < 0.0 ? std::min(level_db, turn_db)
                                                 : level_db;
    highest_m_s = std::clamp(parabola.at(held_db), highest_m_s, wind::kMaxPlausibleSpeed_m_s);
    curve.points.push_back({level_db, highest_m_s});
  }
  return curve;
}

Result<MicPowerLaw, Failure> mic_power_law_through(const MicLevelAndSpeed& soft, const MicLevelAndSpeed& loud,
                                                   double noise_power) {
  const double soft_power = power_of_db(soft.level_db) - noise_power;
  const double loud_power = power_of_db(loud.level_db) - noise_power;
  const bool is_wide = soft.speed_m_s > 0.0 && loud.speed_m_s - soft.speed_m_s >= kMinSpan_m_s &&
                       loud.level_db - soft.level_db >= kMinSpan_db && soft_power > 0.0;
  if (!is_wide) {
    return Failure{
        "the two winds are too similar: they must differ by 1 m/s and 3 dB, and the slower one must be louder than a "
        "calm"};
  }
  // U1 / U2 = (P1 / P2)^(1 / 2n), and the gain from the faster.
  const double exponent = 0.5 * std::log(loud_power / soft_power) / std::log(loud.speed_m_s / soft.speed_m_s);
  if (!(exponent >= kMinExponent && exponent <= kMaxExponent)) {
    return Failure{
        "the sound does not grow with the wind as expected: check that both winds were steady, and that there was no "
        "other "
        "sound"};
  }
  return MicPowerLaw{loud.speed_m_s / std::pow(loud_power, 0.5 / exponent), exponent};
}

Result<MicFit, Failure> fit_mic_calibration(Pairs pairs, double noise_power, MicFitKind kind) {
  if (auto failure = too_little(pairs)) return *failure;
  std::vector<MicLevelAndSpeed> even;
  std::vector<MicLevelAndSpeed> odd;
  for (std::size_t i = 0; i < pairs.size(); ++i) (i % 2 == 0 ? even : odd).push_back(pairs[i]);

  using Fit = std::function<Result<MicCalibration, Failure>(Pairs)>;
  const std::array<Fit, 2> fits = {[noise_power](Pairs some) -> Result<MicCalibration, Failure> {
                                     auto law = fit_mic_power_law(some, noise_power);
                                     if (!law) return law.error();
                                     return MicCalibration(*law);
                                   },
                                   [](Pairs some) -> Result<MicCalibration, Failure> {
                                     auto curve = fit_mic_curve(some);
                                     if (!curve) return curve.error();
                                     return MicCalibration(*curve);
                                   }};

  std::optional<MicFit> best;
  const std::span<const Fit> allowed = kind == MicFitKind::kPowerLaw ? std::span(fits).first(1)
                                       : kind == MicFitKind::kCurve  ? std::span(fits).last(1)
                                                                     : std::span(fits);
  for (const Fit& fit : allowed) {
    const auto whole = fit(pairs);
    if (!whole) continue;
    // Each half is tested with the fit to the other; too few pairs for halves are tested with their own fit.
    const auto by_even = fit(even);
    const auto by_odd = fit(odd);
    const double error = by_even && by_odd
                             ? 0.5 * (mean_error(*by_even, noise_power, odd) + mean_error(*by_odd, noise_power, even))
                             : mean_error(*whole, noise_power, pairs);
    if (!best || error < kClearlyBetter * best->mean_error_m_s) best = MicFit{*whole, error};
  }
  if (!best) return Failure{"neither a power law nor a curve fits: check that the microphone is in the wind"};
  return *best;
}

}  // namespace yuragi::drivers::decode::microphone
