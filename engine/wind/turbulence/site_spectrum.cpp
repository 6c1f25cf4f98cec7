#include "engine/wind/turbulence/site_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/math/portable.hpp"

namespace yuragi::wind::turbulence {
namespace {

constexpr double kMemory_s = 3.0 * 86400.0;
/// The prior has the weight of this much learning ...
constexpr double kExpectedFor_s = 6.0 * 3600.0;
/// ... and without one, 0 dB has this weight, so that the first minutes are adopted gradually.
constexpr double kNothingFor_s = 600.0;
/// A single half hour of a gusty day can differ by this much.
constexpr double kMaxLearnt_db = 20.0;
/// The fastest waves that readings resolve (Fit): frequency times interval.
constexpr double kResolvedUpTo = 0.37;

}  // namespace

double SiteSpectrum::centre_hz(std::size_t octave) noexcept {
  return std::numbers::sqrt2 * std::ldexp(kFrom_hz, static_cast<int>(octave));
}

void SiteSpectrum::expect(std::span<const double> octaves_db) noexcept {
  for (std::size_t octave = 0; octave < std::min(octaves_db.size(), kOctaves); ++octave) {
    if (!std::isfinite(octaves_db[octave])) continue;
    expected_db_[octave] = std::clamp(octaves_db[octave], -kMost_db, kMost_db);
    expected_s_[octave] = kExpectedFor_s;
  }
}

void SiteSpectrum::learn(std::size_t octave, double excess_db, double dt_s) noexcept {
  if (octave >= kOctaves || !std::isfinite(excess_db) || !(dt_s > 0.0)) return;
  const double kept = std::exp(-dt_s / kMemory_s);
  const double new_s = kMemory_s * (1.0 - kept);
  known_s_[octave] = known_s_[octave] * kept + new_s;
  const double limited_db = std::clamp(excess_db, -kMaxLearnt_db, kMaxLearnt_db);
  learnt_db_[octave] += new_s / known_s_[octave] * (limited_db - learnt_db_[octave]);
}

SiteSpectrum::Decibels SiteSpectrum::octaves_db() const noexcept {
  Decibels believed{};
  for (std::size_t octave = 0; octave < kOctaves; ++octave) {
    const double expected_s = expected_s_[octave];
    const double weight_s = known_s_[octave] + expected_s;
    if (weight_s == 0.0) {
      if (octave > 0) believed[octave] = believed[octave - 1];
      continue;
    }
    const double sum = known_s_[octave] * learnt_db_[octave] + expected_s * expected_db_[octave];
    believed[octave] = std::clamp(sum / (weight_s + (expected_s > 0.0 ? 0.0 : kNothingFor_s)), -kMost_db, kMost_db);
  }
  return believed;
}

bool SiteSpectrum::restore(std::span<const double> known_s, std::span<const double> learnt_db) noexcept {
  if (known_s.size() != kOctaves || learnt_db.size() != kOctaves) return false;
  const auto is_time = [](double time_s) { return time_s >= 0.0 && time_s <= 1.001 * kMemory_s; };
  const auto is_level = [](double level_db) { return std::abs(level_db) <= kMaxLearnt_db; };
  if (!std::ranges::all_of(known_s, is_time) || !std::ranges::all_of(learnt_db, is_level)) return false;
  std::ranges::copy(known_s, known_s_.begin());
  std::ranges::copy(learnt_db, learnt_db_.begin());
  return true;
}

double SiteSpectrum::power(double frequency_hz, double interval_s) const noexcept {
  const double resolved_hz = kResolvedUpTo / interval_s;
  if (interval_s <= kQuick_s || frequency_hz <= resolved_hz) return 1.0;
  // Between the middles of octaves by the logarithm; 0 from an octave below the first, constant beyond the last.
  const Decibels octaves = octaves_db();
  const auto level_db = [&octaves](double at_hz) {
    const double place = std::clamp(std::log2(at_hz / centre_hz(0)), -1.0, static_cast<double>(kOctaves - 1));
    const auto above = static_cast<std::size_t>(std::floor(place) + 1.0);
    const double t = place - std::floor(place);
    const double low_db = above > 0 ? octaves[above - 1] : 0.0;
    return low_db + t * (octaves[std::min(above, kOctaves - 1)] - low_db);
  };
  return math::power_of_ten(0.1 * (level_db(frequency_hz) - level_db(resolved_hz)));
}

}  // namespace yuragi::wind::turbulence
