#include "engine/wind/blend/gust_reach_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/math/portable.hpp"
#include "engine/wind/blend/source_estimator.hpp"
#include "engine/wind/turbulence/von_karman.hpp"

namespace yuragi::wind::blend {
namespace {

using turbulence::OctaveFollower;

/// Faster gusts are not compared: sensors and their clocks are not exact enough.
constexpr double kQuickest_hz = 2.0;
constexpr double kSamplesOfAWave = 16.0;
/// A band of a place is used if its sensors resolve this part of it.
constexpr double kMinResolved = 0.8;
constexpr double kPowerMemory_s = 600.0;
/// Powers are used after this time, or this many waves if they take longer.
constexpr double kMinKnown_s = 300.0;
constexpr double kMinKnown_waves = 10.0;
/// If the wind has turned on the way by more than this part of the way, or by a metre, nothing is learnt.
constexpr double kMaxTurn = 0.2;
constexpr double kMinTurn_m = 1.0;
/// The memory of what was learnt.
constexpr double kMemory_s = 4.0 * 3600.0;
constexpr double kMaxStep_s = 10.0;
/// The variance of a product of two samples of unit power is (1 + g^2) / 2 with two components; it counts this many
/// times, because neighbouring samples, bands and pairs are not independent.
constexpr double kSamplesOfOne = 24.0;
/// The deviation of a product from its expectation is limited to this many standard deviations: gusts are not normally
/// distributed.
constexpr double kMaxDeviations = 3.0;

/// Frequencies relative to the band's centre at which its power is summed up, half an octave apart.
constexpr int kPointsBelow = 10;
constexpr int kPointsAbove = 6;
constexpr std::size_t kPoints = kPointsBelow + 1 + kPointsAbove;
struct BandPoint {
  double frequency_times_centre = 1.0;
  double power = 1.0;  ///< response of the band, multiplied by the frequency
};
/// A factor is known within 20 %.
constexpr double kKnownVariance = 0.04;

/// All bands have one shape: the difference of two low passes an octave apart.
const std::array<BandPoint, kPoints>& band_points() noexcept {
  static const std::array<BandPoint, kPoints> all = [] {
    std::array<BandPoint, kPoints> points{};
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double times = math::power_of_two(0.5 * (static_cast<double>(i) - kPointsBelow));
      const double over_edge = std::numbers::sqrt2 * times;
      const double passed =
          over_edge * over_edge / (1.0 + over_edge * over_edge) / (1.0 + 0.25 * over_edge * over_edge);
      points[i] = {.frequency_times_centre = times, .power = passed * times};
    }
    return points;
  }();
  return all;
}

double most_ln() noexcept {
  return std::log(GustReach::kMaxFactor);
}

std::optional<double> factor_if_known(double ln, double variance) noexcept {
  return variance < kKnownVariance ? std::optional(std::exp(ln)) : std::nullopt;
}

}  // namespace

std::optional<double> GustReach::across() const noexcept {
  return factor_if_known(across_ln, across_variance);
}

std::optional<double> GustReach::along() const noexcept {
  return factor_if_known(along_ln, along_variance);
}

bool is_valid(const GustReach& reach) noexcept {
  constexpr double kRounding = 1e-9;
  const auto is_factor = [](double ln) { return std::abs(ln) <= most_ln() + kRounding; };
  const auto is_variance = [](double variance) {
    return variance > 0.0 && variance <= GustReach::kPriorVariance + kRounding;
  };
  return is_factor(reach.across_ln) && is_factor(reach.along_ln) && is_variance(reach.across_variance) &&
         is_variance(reach.along_variance);
}

GustReachFit::GustReachFit(std::size_t place_count)
    : place_count_(place_count), traces_(place_count < 2 ? 0 : place_count * kBands) {
  band_points();  // now, not on the way
}

bool GustReachFit::restore(const GustReach& reach) noexcept {
  if (!is_valid(reach)) return false;
  reach_ = reach;
  covariance_ = 0.0;
  return true;
}

void GustReachFit::advance(double dt_s, const ground::WindStroke& stroke, std::span<const Place> places) noexcept {
  if (traces_.empty() || places.size() < place_count_) return;
  has_observed_ = false;
  since_observed_s_ += dt_s;
  for (std::size_t band = 0; band < kBands; ++band) {
    const double centre_hz = OctaveFollower::centre_hz(band);
    if (centre_hz > kQuickest_hz) break;
    Pace& pace = paces_[band];
    pace.since_s += dt_s;
    if (pace.since_s < 1.0 / (kSamplesOfAWave * centre_hz)) continue;
    pace.newest = (pace.newest + 1) % kSamples;
    sample(band, pace.since_s, stroke, places);
    pace.since_s = 0.0;
    // Weaker wind has no meaningful direction.
    if (stroke.coherence.speed_m_s >= kMinSpeed_m_s) compare(band, stroke, places);
  }
  if (!has_observed_) return;
  const double grown = 1.0 + std::min(since_observed_s_, kMaxStep_s) / kMemory_s;
  since_observed_s_ = 0.0;
  reach_.across_variance = std::min(reach_.across_variance * grown, GustReach::kPriorVariance);
  reach_.along_variance = std::min(reach_.along_variance * grown, GustReach::kPriorVariance);
  const double most = std::sqrt(reach_.across_variance * reach_.along_variance);
  covariance_ = std::clamp(covariance_ * grown, -most, most);
}

/// The present gust of the band at each place.
void GustReachFit::sample(std::size_t band, double passed_s, const ground::WindStroke& stroke,
                          std::span<const Place> places) noexcept {
  for (std::size_t place = 0; place < place_count_; ++place) {
    Trace& one = trace(place, band);
    Sample& now = one.ring[paces_[band].newest];
    const ground::WindPen* pen = places[place].pen;
    now = {.way_m = stroke.way_m,
           .carried_east_m = stroke.carried_east_m,
           .carried_south_m = stroke.carried_south_m,
           .gust = {},
           .is_known = false};
    if (pen == nullptr || pen->weights[1 + band] < kMinResolved) continue;
    now.is_known = true;
    const double per_speed = 1.0 / stroke.coherence.speed_m_s;
    now.gust =
        per_speed * Vector{static_cast<double>(pen->now.east_m_s[band]), static_cast<double>(pen->now.north_m_s[band])};
    one.known_s = std::min(one.known_s + passed_s, kPowerMemory_s);
    const double power = dot(now.gust, now.gust);
    one.power += std::min(passed_s / one.known_s, 1.0) * (power - one.power);
  }
}

void GustReachFit::compare(std::size_t band, const ground::WindStroke& stroke, std::span<const Place> places) noexcept {
  const double least_s = std::max(kMinKnown_s, kMinKnown_waves / OctaveFollower::centre_hz(band));
  const std::size_t newest = paces_[band].newest;
  for (std::size_t i = 0; i < place_count_; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Trace& first = trace(i, band);
      const Trace& second = trace(j, band);
      if (std::min(first.known_s, second.known_s) < std::min(least_s, kPowerMemory_s)) continue;
      if (!first.ring[newest].is_known || !second.ring[newest].is_known) continue;
      const double powers = std::sqrt(first.power * second.power);
      if (!(powers > 0.0)) continue;
      const double east_m = places[j].east_m - places[i].east_m;
      const double north_m = places[i].south_m - places[j].south_m;
      const double along_m = east_m * stroke.ahead.u_m_s + north_m * stroke.ahead.v_m_s;
      const double across_m = north_m * stroke.ahead.u_m_s - east_m * stroke.ahead.v_m_s;
      // The gust that is at j now was at i this much earlier along its way.
      const double before_m = along_m - stroke.coherence.speed_m_s * (places[i].delay_s - places[j].delay_s);
      Vector then;
      if (!read(before_m >= 0.0 ? first : second, newest, stroke.way_m - std::abs(before_m), stroke, then)) continue;
      const Vector now = (before_m >= 0.0 ? second : first).ring[newest].gust;
      observe(band, dot(then, now) / powers, along_m, across_m, stroke.coherence);
    }
  }
}

/// The band at this position along the wind's way. Returns false if it was not known then, or the wind has turned
/// since.
bool GustReachFit::read(const Trace& trace, std::size_t newest, double way_m, const ground::WindStroke& stroke,
                        Vector& gust) const noexcept {
  for (std::size_t back = 0; back + 1 < kSamples; ++back) {
    const Sample& after = trace.ring[(newest + kSamples - back) % kSamples];
    const Sample& before = trace.ring[(newest + kSamples - back - 1) % kSamples];
    if (!after.is_known || !before.is_known) return false;
    if (before.way_m > way_m) continue;
    const double step_m = after.way_m - before.way_m;
    const double part = step_m > 0.0 ? std::clamp((way_m - before.way_m) / step_m, 0.0, 1.0) : 1.0;
    gust = before.gust + part * (after.gust - before.gust);
    const double past_m = stroke.way_m - way_m;
    const double turned_m = math::length(stroke.carried_east_m - before.carried_east_m - past_m * stroke.ahead.u_m_s,
                                         stroke.carried_south_m - before.carried_south_m + past_m * stroke.ahead.v_m_s);
    return turned_m <= std::max(kMaxTurn * past_m, kMinTurn_m) + step_m;
  }
  return false;
}

/// One step of the filter. Expected is the law's root coherence, averaged over the power that the band passes of W5.
void GustReachFit::observe(std::size_t band, double product, double along_m, double across_m,
                           const ground::GustCoherence& law) noexcept {
  const double across = law.decay_across * std::abs(across_m) / (2.0 * std::numbers::pi);
  const double along = law.decay_along * std::abs(along_m) / (2.0 * std::numbers::pi);
  const double time_scale_s = law.length_m / law.speed_m_s;
  double power = 0.0, expected = 0.0, per_across = 0.0, per_along = 0.0;
  for (const BandPoint& point : band_points()) {
    const double frequency_hz = point.frequency_times_centre * OctaveFollower::centre_hz(band);
    const double weight = point.power * turbulence::von_karman_density(frequency_hz * time_scale_s);
    const double loss = law.loss_per_m(frequency_hz);
    const double left = weight * std::exp(-(across + along) * loss);
    power += weight;
    expected += left;
    per_across += left * across * loss;  // a gust with a larger reach loses less
    per_along += left * along * loss;
  }
  expected /= power;
  per_across /= power;
  per_along /= power;

  const double deviation = std::sqrt(0.5 * (1.0 + expected * expected));
  const double surprise = std::clamp(product - expected, -kMaxDeviations * deviation, kMaxDeviations * deviation);
  const double noise = kSamplesOfOne * deviation * deviation;
  const double to_across = reach_.across_variance * per_across + covariance_ * per_along;
  const double to_along = covariance_ * per_across + reach_.along_variance * per_along;
  const double total = per_across * to_across + per_along * to_along + noise;
  reach_.across_ln = std::clamp(reach_.across_ln + to_across / total * surprise, -most_ln(), most_ln());
  reach_.along_ln = std::clamp(reach_.along_ln + to_along / total * surprise, -most_ln(), most_ln());
  reach_.across_variance -= to_across * to_across / total;
  reach_.along_variance -= to_along * to_along / total;
  covariance_ -= to_across * to_along / total;
  has_observed_ = true;
}

}  // namespace yuragi::wind::blend
