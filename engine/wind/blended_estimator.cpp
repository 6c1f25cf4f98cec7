#include "engine/wind/blended_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

namespace yuragi {
namespace {

/// The weight of a band is a half at this over the sensor's interval. What its averaging, its being held and the
/// breadth of the bands leave of it has half the power at 0.25 over the interval: there sensor and noise cross.
constexpr double kHalfTrustTimesInterval = 0.5;
/// A reading is late after so many of its intervals; until then what is known is not yet old.
constexpr double kLateAfterIntervals = 1.5;
/// Trust goes where it should within about 4.75 s: what comes back is believed by and by.
constexpr double kTrustRate_rad_s = 1.0;
/// The slow mean of the speed, by which turbulence is measured.
constexpr double kSpeedMemory_s = 60.0;
constexpr double kLeastSpeed_m_s = 0.5;
/// Gusts go on changing in calm air as if it moved at this.
constexpr double kLeastAdvection_m_s = 0.3;
/// Below this the wind's direction is no direction: what it was is held, the more the calmer it is.
constexpr double kCalm_m_s = 0.5;
constexpr double kTurnRate_hz = 0.1;
/// Standard deviation across the wind over that along it, where nobody measured it (IEC 61400-1, normal turbulence).
constexpr double kAcrossPerAlong = 0.8;
constexpr double kFitEvery_s = 1.0;
/// A gap of so many intervals separates what the fit may compare.
constexpr double kGapIntervals = 3.0;
/// A critically damped step has done 91 % of its way after 4 time constants.
constexpr double kRateTimesDuration = 4.0;

double sinc(double x) noexcept {
  const double angle = std::numbers::pi * x;
  return std::abs(angle) < 1e-6 ? 1.0 : std::sin(angle) / angle;
}

/// The weight of a band while a source speaks as it should.
double full_trust(double centre_hz, double interval_s) noexcept {
  const double ratio = centre_hz * interval_s / kHalfTrustTimesInterval;
  return 1.0 / (1.0 + ratio * ratio * ratio * ratio);
}

}  // namespace

BlendedEstimator::Source::Source(const BlendSettings& settings, const Shares& along_shares, const Shares& across_shares)
    : along{TurbulenceFit({.intensity = settings.climate.turbulence_intensity, .length_m = settings.length_m},
                          settings.fit_memory_s),
            along_shares},
      across{TurbulenceFit(
                 {.intensity = kAcrossPerAlong * settings.climate.turbulence_intensity, .length_m = settings.length_m},
                 settings.fit_memory_s),
             across_shares},
      history(std::size_t{2} << (TurbulenceFit::kScales - 1)) {}

BlendedEstimator::BlendedEstimator(std::size_t source_count, const BlendSettings& settings,
                                   std::shared_ptr<const GustNoise> noise)
    : settings_(settings),
      climate_(wind_from(settings.climate.mean_speed_m_s, settings.climate.mean_direction_deg)),
      noise_(std::move(noise)),
      climate_along_(shares_of(settings.climate.turbulence_intensity, settings.length_m)),
      climate_across_(shares_of(kAcrossPerAlong * settings.climate.turbulence_intensity, settings.length_m)) {
  ground_.gusts.ahead = wind_from(1.0, settings.climate.mean_direction_deg);
  ground_.gusts.carried = noise_->begin(settings.climate.seed);
  sources_.reserve(source_count);
  for (std::size_t i = 0; i < source_count; ++i) sources_.emplace_back(settings, climate_along_, climate_across_);
}

bool BlendedEstimator::accept(std::size_t index, const WindReading& reading) noexcept {
  if (index >= sources_.size() || !is_plausible(reading)) return false;
  Source& source = sources_[index];
  const bool is_first = !source.record.has_spoken();
  const double gap_s = is_first ? 0.0 : seconds(reading.time.mono - source.record.last()->time.mono);
  if (gap_s < 0.0) return false;  // older than what is known
  if (reading.is_held && !is_first) {
    source.record.hold(reading.time);
    return true;
  }
  const double expected_s = source.record.expected_interval_s();
  source.record.take(reading, settings_.climate.mean_direction_deg);
  if (is_first) {
    source.follower.begin(source.record.wind());
    source.speed_m_s = reading.speed_m_s;
  }
  if (gap_s > kGapIntervals * expected_s) source.history_size = 0;
  learn(source);
  return true;
}

/// Keeps the reading, and measures how it differs from those before it.
void BlendedEstimator::learn(Source& source) noexcept {
  const double interval_s = source.record.expected_interval_s();
  const double part = -std::expm1(-interval_s / kSpeedMemory_s);
  source.speed_m_s += part * (source.record.last()->speed_m_s - source.speed_m_s);

  source.history[source.next] = source.record.wind();
  source.next = (source.next + 1) % source.history.size();
  source.history_size = std::min(source.history_size + 1, source.history.size());
  for (Component* component : {&source.along, &source.across}) component->fit.forget(interval_s);
  measure_scales(source);

  source.fitted_s += interval_s;
  if (source.fitted_s < kFitEvery_s) return;
  source.fitted_s = 0.0;
  const double speed_m_s = std::max(source.speed_m_s, kLeastSpeed_m_s);
  for (Component* component : {&source.along, &source.across}) {
    component->fit.fit(interval_s, speed_m_s);
    const Turbulence turbulence = component->fit.turbulence();
    component->shares = shares_of(turbulence.intensity, turbulence.time_scale_s * speed_m_s);
  }
}

/// The differences between the mean of the last 2^s readings and that of as many before, along the wind and across it.
void BlendedEstimator::measure_scales(Source& source) noexcept {
  const double speed_m_s = std::max(source.speed_m_s, kLeastSpeed_m_s);
  const WindVector ahead = ground_.gusts.ahead;
  const std::size_t size = source.history.size();
  const auto reading = [&](std::size_t back) { return source.history[(source.next + size - 1 - back) % size]; };
  WindVector newer{};  // the sum of the last 2^s readings
  std::size_t summed = 0;
  for (std::size_t scale = 0; scale < TurbulenceFit::kScales; ++scale) {
    const std::size_t count = std::size_t{1} << scale;
    if (source.history_size < 2 * count) return;
    for (; summed < count; ++summed) newer = newer + reading(summed);
    WindVector older{};
    for (std::size_t back = count; back < 2 * count; ++back) older = older + reading(back);
    const WindVector difference = 1.0 / (static_cast<double>(count) * speed_m_s) * (newer - older);
    source.along.fit.add(scale, difference.u_m_s * ahead.u_m_s + difference.v_m_s * ahead.v_m_s);
    source.across.fit.add(scale, difference.v_m_s * ahead.u_m_s - difference.u_m_s * ahead.v_m_s);
  }
}

/// The part of the squared mean speed that each octave of the noise has for its variance.
BlendedEstimator::Shares BlendedEstimator::shares_of(double intensity, double length_m) const noexcept {
  // On the ground, in two dimensions: what is left of von Karman's variance above |k|.
  const auto above = [length_m](double rad_m) {
    const double reduced = 1.339 * length_m * rad_m;
    return std::pow(1.0 + reduced * reduced, -1.0 / 3.0);
  };
  // Along the way, in one: at a wind of 1 m/s a wavenumber k is a frequency k / 2 pi.
  const auto along_way = [length_m](double from_rad_m, double to_rad_m) {
    return von_karman_share(from_rad_m / (2.0 * std::numbers::pi), to_rad_m / (2.0 * std::numbers::pi), length_m);
  };

  Shares shares{};
  const auto& octaves = noise_->octaves();
  for (std::size_t which = 0; which < 2; ++which) {
    const std::size_t way = which * GustNoise::kWayOctaves;
    const std::size_t tile = 2 * GustNoise::kWayOctaves + which * GustNoise::kTileOctaves;
    // What is too long for the tiles is the way's. Its first octave stands for all that is longer, too.
    const double longest_rad_m = octaves[tile].from_rad_m;
    const double scale = (1.0 - above(longest_rad_m)) / along_way(0.0, longest_rad_m);
    for (std::size_t i = 0; i < GustNoise::kWayOctaves; ++i) {
      const GustNoise::Octave& octave = octaves[way + i];
      shares[way + i] = scale * along_way(i == 0 ? 0.0 : octave.from_rad_m, octave.to_rad_m);
    }
    for (std::size_t i = 0; i < GustNoise::kTileOctaves; ++i) {
      const GustNoise::Octave& octave = octaves[tile + i];
      shares[tile + i] = above(octave.from_rad_m) - above(octave.to_rad_m);
    }
  }
  for (std::size_t i = 0; i < kOctaves; ++i) shares[i] *= octaves[i].share * intensity * intensity;
  return shares;
}

BlendedEstimator::Source* BlendedEstimator::choose() noexcept {
  // The first that speaks; where none does, whoever had the word keeps it while its trust fades.
  for (Source& source : sources_) {
    if (source.record.is_live(state_.time, settings_.stale_intervals)) return &source;
  }
  const auto loudest = std::ranges::max_element(
      sources_, {}, [](const Source& source) { return source.record.has_spoken() ? source.weight.value : -1.0; });
  return loudest != sources_.end() && loudest->record.has_spoken() ? &*loudest : nullptr;
}

void BlendedEstimator::follow(Source& source, bool is_chosen, double dt_s) noexcept {
  source.follower.step(source.record.wind(), dt_s);
  source.weight.step(is_chosen ? 1.0 : 0.0, kRateTimesDuration / settings_.handover_s, dt_s);

  // What was known of a band is forgotten as fast as its waves pass, and as the gusts do.
  const double interval_s = source.record.expected_interval_s();
  const double late_s = std::max(0.0, source.record.age_s(state_.time) - kLateAfterIntervals * interval_s);
  const double gust_s = source.along.fit.turbulence().time_scale_s;
  for (std::size_t band = 0; band < kBands; ++band) {
    const double centre_hz = OctaveFollower::centre_hz(band);
    const double memory_s = std::min(gust_s, 1.0 / (2.0 * std::numbers::pi * centre_hz));
    const double target = full_trust(centre_hz, interval_s) * std::exp(-late_s / memory_s);
    source.trust[band].step(target, kTrustRate_rad_s, dt_s);
  }
  source.mean_trust.step(std::exp(-late_s / settings_.mean_memory_s), kTrustRate_rad_s, dt_s);

  // What the rest of the tick asks for again and again, for every octave of the noise.
  source.interval_s = interval_s;
  source.mean_share = source.weight.value * source.mean_trust.value;
  for (std::size_t band = 0; band < kBands; ++band) {
    source.shares[band] = source.weight.value * source.trust[band].value;
  }
}

BlendedEstimator::Heard BlendedEstimator::hear() const noexcept {
  Heard heard;
  double known = 0.0;
  double knowable = 0.0;
  for (const Source& source : sources_) {
    if (!source.record.has_spoken()) continue;
    heard.mean = heard.mean + source.mean_share * source.follower.mean();
    heard.weight += source.mean_share;
    heard.speed_m_s += source.mean_share * source.speed_m_s;
    for (std::size_t band = 0; band < kBands; ++band) {
      heard.wind = heard.wind + source.shares[band] * source.follower.band(band);
      known += source.shares[band];
      knowable += source.weight.value * full_trust(OctaveFollower::centre_hz(band), source.interval_s);
    }
  }
  heard.weight = std::clamp(heard.weight, 0.0, 1.0);
  heard.mean = heard.mean + (1.0 - heard.weight) * climate_;
  heard.wind = heard.wind + heard.mean;
  heard.speed_m_s += (1.0 - heard.weight) * settings_.climate.mean_speed_m_s;
  heard.trust = knowable > 0.0 ? std::clamp(known / std::max(knowable, known), 0.0, 1.0) * heard.weight : 0.0;
  return heard;
}

/// The part of the power at a frequency that comes from the sensors.
double BlendedEstimator::power_heard(double frequency_hz) const noexcept {
  std::complex<double> sum = 0.0;
  for (const Source& source : sources_) {
    if (!source.record.has_spoken() || source.weight.value <= 0.0) continue;
    // A reading is a mean over its interval, and is held for as long.
    const double averaged = sinc(frequency_hz * source.interval_s);
    sum += averaged * averaged * OctaveFollower::response(frequency_hz, source.mean_share, source.shares);
  }
  return std::clamp(std::norm(sum), 0.0, 1.0);
}

/// The mean wind carries the gusts, and says where ahead is; their eddies turn over as the turbulence does.
void BlendedEstimator::carry_gusts(const Heard& heard, double dt_s) noexcept {
  WindVector& ahead = ground_.gusts.ahead;
  const double speed_m_s = speed_of(heard.mean);
  if (speed_m_s > 0.0) {
    const double calm = std::clamp(speed_m_s / kCalm_m_s, 0.0, 1.0);
    const double part = -std::expm1(-2.0 * std::numbers::pi * kTurnRate_hz * calm * calm * dt_s);
    const WindVector wanted = ahead + part * ((1.0 / speed_m_s) * heard.mean - ahead);
    // A wind that turned right round has no way between: it waits until it has one.
    if (const double length = speed_of(wanted); length > 1e-3) ahead = (1.0 / length) * wanted;
  }
  advection_m_s_ = std::max(speed_m_s, kLeastAdvection_m_s);
  const Turbulence now = turbulence();
  const double turnover_m23_s = eddy_turnover_m23_s(now.intensity * heard.speed_m_s,
                                                    now.time_scale_s * std::max(heard.speed_m_s, kLeastSpeed_m_s));
  noise_->carry(ground_.gusts.carried, advection_m_s_ * ahead.u_m_s, -advection_m_s_ * ahead.v_m_s, dt_s,
                turnover_m23_s);
}

/// How strong each octave of the noise is: what the sensors leave of it.
void BlendedEstimator::weigh_gusts(const Heard& heard) noexcept {
  const double scale = heard.speed_m_s * heard.speed_m_s;
  for (std::size_t i = 0; i < kOctaves; ++i) {
    const GustNoise::Octave& octave = noise_->octaves()[i];
    const double centre_hz = std::numbers::sqrt2 * octave.from_rad_m * advection_m_s_ / (2.0 * std::numbers::pi);
    // What would jitter from one picture to the next is left out, by and by over the octave before.
    const double shown = std::clamp(std::log2(0.5 * settings_.rate_hz / centre_hz), 0.0, 1.0);
    // Waves of a plane that run aslant pass more slowly than their length tells: what a tile's octave brings is lower
    // by about half an octave, and that is where it would come on top of what the sensors say.
    const double heard_hz = i < 2 * GustNoise::kWayOctaves ? centre_hz : centre_hz / std::numbers::sqrt2;
    const double missing = (1.0 - power_heard(heard_hz)) * shown;
    double variance_along = (1.0 - heard.weight) * climate_along_[i];
    double variance_across = (1.0 - heard.weight) * climate_across_[i];
    for (const Source& source : sources_) {
      if (!source.record.has_spoken() || source.mean_share <= 0.0) continue;
      variance_along += source.mean_share * source.along.shares[i] * source.along.fit.correction(centre_hz);
      variance_across += source.mean_share * source.across.shares[i] * source.across.fit.correction(centre_hz);
    }
    ground_.gusts.along_m_s[i] = static_cast<float>(std::sqrt(missing * scale * variance_along));
    ground_.gusts.across_m_s[i] = static_cast<float>(std::sqrt(missing * scale * variance_across));
  }
}

WindState BlendedEstimator::advance(MonoTime now) noexcept {
  if (!has_begun_) {
    has_begun_ = true;
    state_.time = now;
  }
  if (now < state_.time) return state_;
  const double dt_s = seconds(now - state_.time);
  state_.time = now;

  const Source* chosen = choose();
  for (Source& source : sources_) {
    if (source.record.has_spoken()) follow(source, &source == chosen, dt_s);
  }
  const Heard heard = hear();
  carry_gusts(heard, dt_s);
  weigh_gusts(heard);
  ground_.everywhere = heard.wind + noise_->everywhere(ground_.gusts);
  state_.wind = ground_.at(*noise_, 0.0, 0.0);
  if (const double speed_m_s = speed_of(state_.wind); speed_m_s > kMaxPlausibleSpeed_m_s) {
    state_.wind = (kMaxPlausibleSpeed_m_s / speed_m_s) * state_.wind;
  }

  state_.live_weight = heard.trust;
  state_.reading_age_s = chosen != nullptr ? chosen->record.age_s(now) : 0.0;
  state_.source = heard.trust > 0.99   ? WindSource::kLive
                  : heard.trust < 0.01 ? WindSource::kDefault
                                       : WindSource::kHandover;
  return state_;
}

SourceReport BlendedEstimator::report(std::size_t index) const noexcept {
  return sources_[index].record.report(state_.time, settings_.stale_intervals);
}

Turbulence BlendedEstimator::turbulence() const noexcept {
  for (const Source& source : sources_) {
    if (source.weight.value > 0.5) return source.along.fit.turbulence();
  }
  return {settings_.climate.turbulence_intensity,
          settings_.length_m / std::max(settings_.climate.mean_speed_m_s, kLeastSpeed_m_s)};
}

}  // namespace yuragi
