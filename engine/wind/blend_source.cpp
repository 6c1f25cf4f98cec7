#include "engine/wind/blend_source.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace yuragi {
namespace {

/// The weight of a band is a half at this over the sensor's interval. What its averaging, its being held and the
/// breadth of the bands leave of it has half the power at 0.25 over the interval: there sensor and noise cross.
constexpr double kHalfTrustTimesInterval = 0.5;
/// A reading is late after so many of its intervals; until then what is known is not yet old.
constexpr double kLateAfterIntervals = 1.5;
/// A gap of so many intervals separates what the fit may compare.
constexpr double kGapIntervals = 3.0;
/// Trust goes where it should within about 4.75 s: what comes back is believed by and by.
constexpr double kTrustRate_rad_s = 1.0;
/// The slow mean of the speed, by which turbulence is measured.
constexpr double kSpeedMemory_s = 60.0;
constexpr double kFitEvery_s = 1.0;
/// A difference between two means, over the mean speed, counts as at most this. A wind that rises out of a calm differs
/// by many times the mean that it rises from, which tells how fast that mean follows and not how strong the gusts are.
constexpr double kLargestDifference = 1.0;

double sinc(double x) noexcept {
  const double angle = std::numbers::pi * x;
  return std::abs(angle) < 1e-6 ? 1.0 : std::sin(angle) / angle;
}

/// The weight of a band while a source that tells of so long a time at once speaks as it should.
double full_trust_at(double frequency_hz, double interval_s) noexcept {
  const double ratio = frequency_hz * interval_s / kHalfTrustTimesInterval;
  return 1.0 / (1.0 + ratio * ratio * ratio * ratio);
}

/// A mean over `averaging_s`, held for `interval_s`: what both leave of a wave, and how much later it is.
std::complex<double> averaged_and_held(double frequency_hz, double averaging_s, double interval_s) noexcept {
  const double passed = sinc(frequency_hz * averaging_s) * sinc(frequency_hz * interval_s);
  return std::polar(1.0, -std::numbers::pi * frequency_hz * (averaging_s + interval_s)) * passed;
}

BandWeights full_trust_of(double interval_s) noexcept {
  BandWeights trust{};
  trust[0] = 1.0;
  for (std::size_t band = 0; band < OctaveFollower::kBands; ++band) {
    trust[1 + band] = full_trust_at(OctaveFollower::centre_hz(band), interval_s);
  }
  return trust;
}

}  // namespace

BlendSource::BlendSource(const BlendSettings& blend, const BlendSourceSettings& settings, const GustNoise& noise)
    : scale(blend.fit_memory_s),
      settings_(settings),
      mean_memory_s_(blend.mean_memory_s),
      noise_(&noise),
      direction_(settings.direction_step_deg),
      along_(component(blend, settings, noise, blend.climate.turbulence_intensity)),
      across_(component(blend, settings, noise, kAcrossPerAlong * blend.climate.turbulence_intensity)),
      history_(std::size_t{2} << (TurbulenceFit::kScales - 1)) {
  turbulence_ = along_.fit.turbulence();
}

/// What is believed of its turbulence before it has spoken.
BlendSource::Component BlendSource::component(const BlendSettings& blend, const BlendSourceSettings& settings,
                                              const GustNoise& noise, double intensity) {
  const double length_m = settings.length_m > 0.0 ? settings.length_m : blend.length_m;
  return {.fit = TurbulenceFit({.intensity = intensity, .length_m = length_m}, blend.fit_memory_s),
          .variances = gust_variances(noise, intensity, length_m)};
}

bool BlendSource::accept(const WindReading& reading, const Around& around) noexcept {
  if (!is_plausible(reading)) return false;
  const bool is_first = !record_.has_spoken();
  const double gap_s = is_first ? 0.0 : seconds(reading.time.mono - record_.last()->time.mono);
  if (gap_s < 0.0) return false;  // older than what is known
  if (reading.is_held && !is_first) {
    record_.hold(reading.time);
    return true;
  }
  if (gap_s > kGapIntervals * record_.expected_interval_s()) history_size_ = 0;

  record_.take(reading);
  wind_ = reading.speed_m_s * direction_.take(reading, gap_s, around.ahead, around.is_direction_live);
  set_full_trust();
  if (is_first) begin();

  // The turbulence. Of running means only as many are compared as do not overlap.
  const double interval_s = record_.expected_interval_s();
  for (Component* component : {&along_, &across_}) component->fit.forget(interval_s);
  const double readings_of_one = std::max(1.0, std::round(averaging_s() / interval_s));
  if (static_cast<double>(++since_kept_) >= readings_of_one) {
    since_kept_ = 0;
    history_[next_] = wind_;
    next_ = (next_ + 1) % history_.size();
    history_size_ = std::min(history_size_ + 1, history_.size());
    measure_scales(around.ahead);
  }
  fitted_s_ += interval_s;
  if (fitted_s_ >= kFitEvery_s) fit(readings_of_one * interval_s, around.advection_m_s);
  return true;
}

/// With its first reading it is what it says, believed at once: nothing of it is shown yet, and how it comes into the
/// wind is SourceChoice's.
void BlendSource::begin() noexcept {
  follower_.begin(wind_);
  speed_m_s_ = record_.last()->speed_m_s;
  for (std::size_t i = 0; i < trusts_.size(); ++i) trusts_[i].value = trust_[i] = full_trust_[i];
}

double BlendSource::averaging_s() const noexcept {
  return settings_.averaging_s > 0.0 ? settings_.averaging_s : record_.expected_interval_s();
}

double BlendSource::slowness_s() const noexcept {
  return std::max(record_.expected_interval_s(), averaging_s());
}

double BlendSource::trust_at(double frequency_hz) const noexcept {
  return full_trust_at(frequency_hz, slowness_s());
}

/// When the interval has changed.
void BlendSource::set_full_trust() noexcept {
  if (record_.expected_interval_s() == interval_s_) return;
  interval_s_ = record_.expected_interval_s();
  full_trust_ = full_trust_of(slowness_s());
  passed_[0] = 1.0;
  for (std::size_t band = 0; band < OctaveFollower::kBands; ++band) {
    passed_[1 + band] = std::abs(averaged_and_held(OctaveFollower::centre_hz(band), averaging_s(), interval_s_));
  }
}

/// The differences between the mean of the last 2^s readings and that of as many before, along the wind and across it.
void BlendSource::measure_scales(WindVector ahead) noexcept {
  const double speed_m_s = std::max(speed_m_s_, kLeastSpeed_m_s);
  const bool tells_across = has_vane() && !is_coarse();
  const std::size_t size = history_.size();
  const auto reading = [&](std::size_t back) { return history_[(next_ + size - 1 - back) % size]; };
  WindVector newer{};  // the sum of the last 2^s readings
  std::size_t summed = 0;
  for (std::size_t scale_index = 0; scale_index < TurbulenceFit::kScales; ++scale_index) {
    const std::size_t count = std::size_t{1} << scale_index;
    if (history_size_ < 2 * count) return;
    for (; summed < count; ++summed) newer = newer + reading(summed);
    WindVector older{};
    for (std::size_t back = count; back < 2 * count; ++back) older = older + reading(back);
    const WindVector difference = 1.0 / (static_cast<double>(count) * speed_m_s) * (newer - older);
    const auto limited = [](double value) { return std::clamp(value, -kLargestDifference, kLargestDifference); };
    along_.fit.add(scale_index, limited(difference.u_m_s * ahead.u_m_s + difference.v_m_s * ahead.v_m_s));
    if (!tells_across) continue;
    across_.fit.add(scale_index, limited(difference.v_m_s * ahead.u_m_s - difference.u_m_s * ahead.v_m_s));
  }
}

/// Fits the turbulence to what was measured, and works out what the noise should have of it.
void BlendSource::fit(double interval_s, double advection_m_s) noexcept {
  fitted_s_ = 0.0;
  const double speed_m_s = std::max(speed_m_s_, kLeastSpeed_m_s);
  for (Component* component : {&along_, &across_}) {
    component->fit.fit(interval_s, speed_m_s);
    const Turbulence turbulence = component->fit.turbulence();
    component->variances = gust_variances(*noise_, turbulence.intensity, turbulence.time_scale_s * speed_m_s);
    for (std::size_t i = 0; i < GustNoise::kOctaves; ++i) {
      component->variances[i] *= component->fit.correction(centre_hz(noise_->octaves()[i], advection_m_s));
    }
  }
  // What no vane tells, or one of few points, is as a rule.
  if (!has_vane() || is_coarse()) {
    for (std::size_t i = 0; i < GustNoise::kOctaves; ++i) {
      across_.variances[i] = kAcrossPerAlong * kAcrossPerAlong * along_.variances[i];
    }
  }
  turbulence_ = along_.fit.turbulence();
  direction_.expect(kAcrossPerAlong * turbulence_.intensity, turbulence_.time_scale_s, record_.expected_interval_s());
}

void BlendSource::step(MonoTime now, double dt_s, const OctaveFollower::Parts& parts) noexcept {
  follower_.step(wind_, parts);

  // What was known of a band is forgotten as fast as its waves pass, and as the gusts do.
  const double late_s = std::max(0.0, record_.age_s(now) - kLateAfterIntervals * interval_s_);
  if (late_s == 0.0) {
    // Until it has spoken for so long, the mean of all that it has said.
    spoken_s_ = std::min(spoken_s_ + dt_s, kSpeedMemory_s);
    if (spoken_s_ > 0.0) {
      speed_m_s_ += -std::expm1(-dt_s / spoken_s_) * (record_.last()->speed_m_s - speed_m_s_);
    }
  }
  for (std::size_t i = 0; i < trusts_.size(); ++i) {
    double kept = 1.0;
    if (late_s > 0.0 && i == 0) kept = std::exp(-late_s / mean_memory_s_);
    if (late_s > 0.0 && i > 0) {
      const double wave_s = 1.0 / (2.0 * std::numbers::pi * OctaveFollower::centre_hz(i - 1));
      kept = std::exp(-late_s / std::min(turbulence_.time_scale_s, wave_s));
    }
    trusts_[i].step(kept * full_trust_[i], kTrustRate_rad_s, dt_s);
    trust_[i] = std::clamp(trusts_[i].value, 0.0, 1.0);
  }
}

SourceResponse BlendSource::response(double frequency_hz, const OctaveFollower::Response& response,
                                     const BandWeights& weights) const noexcept {
  const std::complex<double> along =
      averaged_and_held(frequency_hz, averaging_s(), interval_s_) * response.weighted(weights);
  if (!has_vane()) return {along, 0.0};
  const std::complex<double> vane(1.0, 2.0 * std::numbers::pi * frequency_hz * direction_.memory_s());
  return {along, along / vane};
}

double blend_group_delay_s(double frequency_hz, double interval_s, double averaging_s) noexcept {
  const BandWeights trust = full_trust_of(std::max(interval_s, averaging_s));
  // The slope of the phase, over a hundredth of the frequency on either side.
  const double below_hz = 0.99 * frequency_hz;
  const double above_hz = 1.01 * frequency_hz;
  const std::complex<double> turn = OctaveFollower::Response(above_hz).weighted(trust) *
                                    std::conj(OctaveFollower::Response(below_hz).weighted(trust));
  return 0.5 * (averaging_s + interval_s) - std::arg(turn) / (2.0 * std::numbers::pi * (above_hz - below_hz));
}

}  // namespace yuragi
