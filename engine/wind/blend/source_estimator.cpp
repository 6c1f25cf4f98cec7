#include "engine/wind/blend/source_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace yuragi::wind::blend {
namespace {

/// The weight of a band is 0.5 at this over the sensor's interval. With averaging, hold and the width of the bands the
/// sensor's part has half the power at 0.25 over the interval: the crossover of sensor and noise.
constexpr double kHalfTrustTimesInterval = 0.5;
/// A reading is late after this many of its intervals; until then weights do not decay.
constexpr double kLateAfterIntervals = 1.5;
/// The interval assumed of a source that has sent one reading: a long one, so that the reading counts for a while and
/// sets the mean, while the gusts are left to the noise until the next.
constexpr double kUnknownInterval_s = 10.0;
/// The fit compares no readings across a gap of this many intervals.
constexpr double kGapIntervals = 3.0;
/// The rate at which weights are slewed: 95 % of the way in 4.75 s.
constexpr double kTrustRate_rad_s = 1.0;
/// The slow mean of the speed, by which turbulence is measured.
constexpr double kSpeedMemory_s = 60.0;
constexpr double kFitEvery_s = 1.0;
/// The assumption about a station changes only with an interval this many times beyond the limit.
constexpr double kBeyondLimit = 1.2;

/// A configured length of a source weighs more than the climate's intensity, which is not specific to the site: means
/// over times that are longer than a gust determine only the product of the variance and the time scale, so that the
/// prior of one fixes the other. Found with two half hours at 4.4 m and synthetic storms of 20 m/s at 15 m
/// (site_proof).
constexpr double kOwnLengthWeight = 5.0;
constexpr double kOwnLengthIntensityWeight = 1.0;

/// The weight of a band of a source with this interval, or averaging time, while its readings are on time
/// (engine/wind/model.md W18).
double full_trust_at(double frequency_hz, double interval_s) noexcept {
  const double ratio = frequency_hz * interval_s / kHalfTrustTimesInterval;
  return 1.0 / (1.0 + ratio * ratio * ratio * ratio);
}

/// The mean of a wave over this many past cycles, as a complex factor: sinc(cycles) exp(-i pi cycles).
std::complex<double> mean_of_past(double cycles) noexcept {
  const double angle_rad = std::numbers::pi * cycles;
  const double sine = std::sin(angle_rad);
  const double height = std::abs(angle_rad) < 1e-6 ? 1.0 : sine / angle_rad;
  return {height * std::cos(angle_rad), -height * sine};
}

/// The response of a mean over `averaging_s` that is held for `interval_s`, as a complex factor (W19).
std::complex<double> averaged_and_held(double frequency_hz, double averaging_s, double interval_s) noexcept {
  const std::complex<double> held = mean_of_past(frequency_hz * interval_s);
  return held * (averaging_s == interval_s ? held : mean_of_past(frequency_hz * averaging_s));
}

BandWeights full_trust_of(double interval_s, const UnfoldedPart& unfolded = {}) noexcept {
  BandWeights trust{};
  trust[0] = 1.0;
  for (std::size_t band = 0; band < turbulence::OctaveFollower::kBands; ++band) {
    const double centre_hz = turbulence::OctaveFollower::centre_hz(band);
    trust[1 + band] = full_trust_at(centre_hz, interval_s) * unfolded.at(centre_hz);
  }
  return trust;
}

}  // namespace

turbulence::Prior turbulence_prior(const Settings& blend, const SourceSettings& settings) noexcept {
  turbulence::Prior prior{.intensity = blend.climate.turbulence_intensity, .length_m = blend.length_m};
  if (settings.length_m > 0.0) {
    prior.length_m = settings.length_m;
    prior.length_weight = kOwnLengthWeight;
    prior.intensity_weight = kOwnLengthIntensityWeight;
  }
  return prior;
}

SourceEstimator::SourceEstimator(const Settings& blend, const SourceSettings& settings,
                                 const turbulence::GustNoise& noise)
    : scale(blend.fit_memory_s),
      settings_(settings),
      taken_(settings.value == ReadingValue::kUnknown ? assumed_value(kUnknownInterval_s) : settings.value),
      mean_memory_s_(blend.mean_memory_s),
      noise_(&noise),
      record_(settings.unchanged_for_s),
      direction_(settings.direction_step_deg),
      measured_(turbulence_prior(blend, settings), blend.fit_memory_s, settings.value),
      turbulence_(measured_.along().turbulence()),
      along_(turbulence::gust_variances(noise, blend.climate.turbulence_intensity,
                                        turbulence_prior(blend, settings).length_m)),
      across_(turbulence::gust_variances(noise, turbulence::kAcrossPerAlong * blend.climate.turbulence_intensity,
                                         turbulence_prior(blend, settings).length_m)),
      site_(blend.site),
      site_fit_(turbulence_prior(blend, settings), blend.fit_memory_s) {
  if (settings.value == ReadingValue::kUnknown) measured_.take_as(taken_);
}

bool SourceEstimator::accept(const Reading& reading, const Around& around) noexcept {
  if (!makes_wind(settings_.value) || !is_plausible(reading)) return false;
  const bool is_first = !record_.has_reading();
  const double gap_s = is_first ? 0.0 : seconds(reading.time.mono - record_.last()->time.mono);
  if (gap_s < 0.0) return false;  // older than the last reading
  if (reading.is_held && !is_first) {
    record_.hold(reading.time);
    return true;
  }
  if (gap_s > kGapIntervals * expected_interval_s()) {
    measured_.break_off();
    site_fit_.break_off();
  }

  const bool repeats = !is_first && has_same_values(reading, *record_.last());
  const bool is_new = record_.take(reading);
  if (!is_new && repeats) return true;
  wind_ = reading.speed_m_s * direction_.take(reading, gap_s, around.ahead, around.is_direction_live);
  set_interval();
  if (is_first) begin();
  if (!is_new) return true;  // another one of the same burst: not an independent sample of the turbulence

  // The turbulence. Only running means that do not overlap are compared.
  const double interval_s = expected_interval_s();
  measured_.forget(interval_s);
  const double readings_of_one = std::max(1.0, std::round(averaging_s() / interval_s));
  const double mean_of_s = readings_of_one * interval_s;
  if (static_cast<double>(++since_kept_) >= readings_of_one) {
    since_kept_ = 0;
    measure(around.ahead, mean_of_s);
  }
  fitted_s_ += interval_s;
  if (fitted_s_ >= kFitEvery_s) fit(mean_of_s, around.advection_m_s);
  return true;
}

/// The first reading has its full weight at once: the source is not yet shown, and SourceChoice fades it into the wind.
void SourceEstimator::begin() noexcept {
  follower_.begin(wind_);
  speed_m_s_ = record_.last()->speed_m_s;
  for (std::size_t i = 0; i < trusts_.size(); ++i) trusts_[i].value = trust_[i] = full_trust_[i];
}

double SourceEstimator::expected_interval_s() const noexcept {
  return record_.interval_s() > 0.0 ? record_.interval_s() : kUnknownInterval_s;
}

double SourceEstimator::averaging_s() const noexcept {
  if (taken_ == ReadingValue::kInstant) return 0.0;
  return settings_.averaging_s > 0.0 ? settings_.averaging_s : expected_interval_s();
}

double SourceEstimator::slowness_s() const noexcept {
  return std::max(expected_interval_s(), averaging_s());
}

double SourceEstimator::trust_at(double frequency_hz) const noexcept {
  return full_trust_at(frequency_hz, slowness_s()) * unfolded_.at(frequency_hz);
}

/// The assumed value of readings with an unknown one: judged from them, or assumed from their interval; it changes only
/// with an interval well beyond the limit.
ReadingValue SourceEstimator::likely_value() const noexcept {
  if (const ReadingValue judged = measured_.verdict(); judged != ReadingValue::kUnknown) return judged;
  const double nearer_s = taken_ == ReadingValue::kInstant ? interval_s_ / kBeyondLimit : interval_s_ * kBeyondLimit;
  return assumed_value(nearer_s) == taken_ ? taken_ : assumed_value(interval_s_);
}

/// Returns false if nothing changes. Weights follow slowly, and the turbulence with its next fit.
bool SourceEstimator::set_taken() noexcept {
  if (settings_.value != ReadingValue::kUnknown) return false;
  const ReadingValue likely = likely_value();
  if (likely == taken_) return false;
  taken_ = likely;
  measured_.take_as(likely);
  if (likely == ReadingValue::kMean) unfolded_ = {};
  return true;
}

/// When it has changed.
void SourceEstimator::set_interval() noexcept {
  if (expected_interval_s() == interval_s_) return;
  interval_s_ = expected_interval_s();
  set_taken();
  set_full_trust();
  set_passed();
}

void SourceEstimator::set_passed() noexcept {
  passed_[0] = 1.0;
  for (std::size_t band = 0; band < turbulence::OctaveFollower::kBands; ++band) {
    passed_[1 + band] = std::sqrt(
        std::norm(averaged_and_held(turbulence::OctaveFollower::centre_hz(band), averaging_s(), interval_s_)));
  }
}

/// Called when the interval has changed, or the fitted turbulence, which sets the trust in instantaneous samples.
void SourceEstimator::set_full_trust() noexcept {
  if (taken_ == ReadingValue::kInstant) unfolded_.set(interval_s_, turbulence_.time_scale_s);
  full_trust_ = full_trust_of(slowness_s(), unfolded_);
}

/// Adds a reading, a mean over this time or the wind at its end, to the turbulence, and to the site's spectrum if the
/// source can update it.
void SourceEstimator::measure(Vector ahead, double mean_of_s) noexcept {
  const double speed_m_s = std::max(speed_m_s_, kMinSpeed_m_s);
  const bool has_across = has_vane() && !is_coarse();
  measured_.take(wind_, ahead, speed_m_s, has_across);
  if (!site_ || !settings_.fits_site || record_.last()->quality == ReadingQuality::kSimulated) return;
  site_fit_.observe(
      {.wind = wind_, .ahead = ahead, .speed_m_s = speed_m_s, .interval_s = mean_of_s, .has_across = has_across},
      measured_, *site_);
}

/// Fits the turbulence to the readings, and computes the variance of each octave of the noise from the fit.
void SourceEstimator::fit(double interval_s, double advection_m_s) noexcept {
  fitted_s_ = 0.0;
  const double speed_m_s = std::max(speed_m_s_, kMinSpeed_m_s);
  measured_.fit(interval_s, speed_m_s);
  turbulence_ = measured_.along().turbulence();
  const bool is_other = set_taken();
  if (is_other) set_passed();
  if (is_other || taken_ == ReadingValue::kInstant) set_full_trust();
  const auto strengths = [&](const turbulence::Fit& fit) {
    const turbulence::Turbulence turbulence = fit.turbulence();
    turbulence::GustVariances variances =
        turbulence::gust_variances(*noise_, turbulence.intensity, turbulence.time_scale_s * speed_m_s);
    for (std::size_t i = 0; i < turbulence::GustNoise::kOctaves; ++i) {
      const double frequency_hz = turbulence::centre_hz(noise_->octaves()[i], advection_m_s);
      variances[i] *= fit.correction(frequency_hz);
      if (site_) variances[i] *= site_->power(frequency_hz, interval_s);
    }
    return variances;
  };
  along_ = strengths(measured_.along());
  // Without a vane, or with one of few points, the usual ratio is used.
  if (has_vane() && !is_coarse()) {
    across_ = strengths(measured_.across());
  } else {
    across_ = along_;
    for (double& variance : across_) variance *= turbulence::kAcrossPerAlong * turbulence::kAcrossPerAlong;
  }
  direction_.expect(turbulence::kAcrossPerAlong * turbulence_.intensity, turbulence_.time_scale_s,
                    expected_interval_s());
}

void SourceEstimator::step(MonoTime now, double dt_s, const turbulence::OctaveFollower::Parts& parts) noexcept {
  follower_.step(wind_, parts);

  // The weight of a band decays at the rate at which its waves, and the gusts, pass (W21).
  const double on_time_s = std::max(kLateAfterIntervals * interval_s_, record_.explained_s(kLateAfterIntervals));
  const double late_s = std::max(0.0, record_.age_s(now) - on_time_s);
  if (late_s == 0.0) {
    // Until its readings span the memory, the mean of all of them.
    measured_s_ = std::min(measured_s_ + dt_s, kSpeedMemory_s);
    if (measured_s_ > 0.0) {
      speed_m_s_ += -std::expm1(-dt_s / measured_s_) * (record_.last()->speed_m_s - speed_m_s_);
    }
  }
  for (std::size_t i = 0; i < trusts_.size(); ++i) {
    double kept = 1.0;
    if (late_s > 0.0 && i == 0) kept = std::exp(-late_s / mean_memory_s_);
    if (late_s > 0.0 && i > 0) {
      const double wave_s = 1.0 / (2.0 * std::numbers::pi * turbulence::OctaveFollower::centre_hz(i - 1));
      kept = std::exp(-late_s / std::min(turbulence_.time_scale_s, wave_s));
    }
    trusts_[i].step(kept * full_trust_[i], kTrustRate_rad_s, dt_s);
    trust_[i] = std::clamp(trusts_[i].value, 0.0, 1.0);
  }
}

SourceResponse SourceEstimator::passed_of(double frequency_hz) const noexcept {
  const std::complex<double> along = averaged_and_held(frequency_hz, averaging_s(), interval_s_);
  if (!has_vane()) return {along, 0.0};
  const std::complex<double> vane(1.0, 2.0 * std::numbers::pi * frequency_hz * direction_.memory_s());
  return {along, 1.0 / std::norm(vane) * along * std::conj(vane)};
}

double blend_group_delay_s(double frequency_hz, double interval_s, double averaging_s) noexcept {
  const BandWeights trust = full_trust_of(std::max(interval_s, averaging_s));
  // The slope of the phase, over a hundredth of the frequency on either side.
  const double below_hz = 0.99 * frequency_hz;
  const double above_hz = 1.01 * frequency_hz;
  const std::complex<double> turn = turbulence::OctaveFollower::Response(above_hz).weighted(trust) *
                                    std::conj(turbulence::OctaveFollower::Response(below_hz).weighted(trust));
  return 0.5 * (averaging_s + interval_s) - std::arg(turn) / (2.0 * std::numbers::pi * (above_hz - below_hz));
}

}  // namespace yuragi::wind::blend
