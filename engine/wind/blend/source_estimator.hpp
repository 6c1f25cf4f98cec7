#pragma once

#include <array>
#include <complex>
#include <memory>

#include "engine/base/state_pass.hpp"
#include "engine/math/critically_damped.hpp"
#include "engine/wind/blend/blend_settings.hpp"
#include "engine/wind/blend/direction_keeper.hpp"
#include "engine/wind/blend/relative_scale.hpp"
#include "engine/wind/blend/site_spectrum_fit.hpp"
#include "engine/wind/blend/source_record.hpp"
#include "engine/wind/blend/unfolded_part.hpp"
#include "engine/wind/turbulence/gust_variances.hpp"
#include "engine/wind/turbulence/octave_follower.hpp"
#include "engine/wind/turbulence/wind_turbulence.hpp"

namespace yuragi::wind::blend {

/// Turbulence is measured relative to the mean speed; with a weaker mean than this it is not measured.
inline constexpr double kMinSpeed_m_s = 0.5;

/// A number for the mean (0) and each octave band (1 + band) of a source.
using BandWeights = std::array<double, turbulence::OctaveFollower::kBands + 1>;

/// A complex response along the wind and across it.
struct SourceResponse {
  std::complex<double> along, across;
};

/// The prior of a source's turbulence, before it has sent readings. Pure.
turbulence::Prior turbulence_prior(const Settings& blend, const SourceSettings& settings) noexcept;

/// One source of a blend: its readings split into octave bands (engine/wind/model.md W17), the weight of each band
/// (W18, W21), and the turbulence fitted to its readings (W28, W29). Thread-safe: no. Realtime-safe after construction:
/// yes.
class SourceEstimator {
 public:
  SourceEstimator(const Settings& blend, const SourceSettings& settings, const turbulence::GustNoise& noise);

  /// Inputs for a source without a vane, and for the fit.
  struct Around {
    Vector ahead{0.0, 1.0};          ///< unit vector downwind
    bool is_direction_live = false;  ///< another source measures it
    double advection_m_s = 1.0;      ///< how fast gusts pass
  };

  /// Takes a reading. Returns false if it is impossible, a maximum, or older than the last one.
  bool accept(const Reading& reading, const Around& around) noexcept;

  /// Advances to `now`. Precondition: it has sent a reading.
  void step(MonoTime now, double dt_s, const turbulence::OctaveFollower::Parts& parts) noexcept;

  /// The value as which its readings are used; never kUnknown.
  TakenValue taken() const noexcept {
    return {.value = taken_, .is_judged = measured_.verdict() != ReadingValue::kUnknown};
  }

  const SourceRecord& record() const noexcept { return record_; }
  bool has_vane() const noexcept { return direction_.has_vane(); }
  bool is_coarse() const noexcept { return direction_.is_coarse(); }

  Vector mean() const noexcept { return follower_.mean(); }
  Vector band(std::size_t band) const noexcept { return follower_.band(band); }
  double speed_m_s() const noexcept { return speed_m_s_; }  ///< slow mean of its speeds

  /// The weights of the mean and of each band, 0 to 1, slewed; and those that it has while its readings are on time.
  const BandWeights& trust() const noexcept { return trust_; }
  const BandWeights& full_trust() const noexcept { return full_trust_; }
  /// The part of a wave in the middle of each band that remains after averaging and holding.
  const BandWeights& passed() const noexcept { return passed_; }

  /// Its frequency response (W19): the part of a wave of the real wind that remains after averaging, the holding of
  /// readings and its vane. Multiplied by the response of its bands (OctaveFollower::Response) it is the source's part
  /// of the blend.
  SourceResponse passed_of(double frequency_hz) const noexcept;
  /// The delay of its readings: half of the averaging time, and half of the time for which they are held.
  double reading_delay_s() const noexcept { return 0.5 * (averaging_s() + expected_interval_s()); }
  /// The power that is aliased to this frequency, relative to the wind's own there (W40): 0 for means.
  double folded_over_own(double frequency_hz) const noexcept {
    return taken_ == ReadingValue::kInstant ? 1.0 / unfolded_.at(frequency_hz) - 1.0 : 0.0;
  }
  /// The weight of a wave of this frequency while readings are on time (W18, W40).
  double trust_at(double frequency_hz) const noexcept;

  const turbulence::Turbulence& turbulence() const noexcept { return turbulence_; }  ///< along the wind
  const turbulence::GustVariances& along() const noexcept { return along_; }
  const turbulence::GustVariances& across() const noexcept { return across_; }

  RelativeScale scale;  ///< of a relative source

  /// Without the site's spectrum, which sources share.
  void list_state(StatePass& pass) {
    pass.choice(taken_, ReadingValue::kUnknown);
    pass(record_, direction_, wind_, follower_, trusts_, trust_, full_trust_, passed_, unfolded_, interval_s_,
         speed_m_s_, measured_s_, measured_, turbulence_, along_, across_, site_fit_, since_kept_, scale);
    pass.total(fitted_s_);
  }

 private:
  void begin() noexcept;
  double expected_interval_s() const noexcept;
  double averaging_s() const noexcept;
  double slowness_s() const noexcept;
  void set_interval() noexcept;
  ReadingValue likely_value() const noexcept;
  bool set_taken() noexcept;
  void set_passed() noexcept;
  void set_full_trust() noexcept;
  void measure(Vector ahead, double mean_of_s) noexcept;
  void fit(double interval_s, double advection_m_s) noexcept;

  SourceSettings settings_;
  ReadingValue taken_;  ///< not kUnknown
  double mean_memory_s_;
  const turbulence::GustNoise* noise_;

  SourceRecord record_;
  DirectionKeeper direction_;
  Vector wind_;  ///< that is held
  turbulence::OctaveFollower follower_;
  std::array<math::CriticallyDamped, turbulence::OctaveFollower::kBands + 1> trusts_{};
  BandWeights trust_{}, full_trust_{}, passed_{};
  UnfoldedPart unfolded_;
  double interval_s_ = 0.0;  ///< the interval for which the full trust is computed
  double speed_m_s_ = 0.0;
  double measured_s_ = 0.0;  ///< duration, at most the memory of that speed

  turbulence::WindTurbulence measured_;
  turbulence::Turbulence turbulence_;
  turbulence::GustVariances along_, across_;  ///< its variance in each octave of the noise
  std::shared_ptr<turbulence::SiteSpectrum> site_;
  SiteSpectrumFit site_fit_;
  std::size_t since_kept_ = 0;  ///< readings
  double fitted_s_ = 0.0;       ///< time since the last fit
};

/// The group delay of the blend, s: the delay of the blend behind the wind at this frequency, for a source that sends a
/// reading every `interval_s`, each the mean over `averaging_s`. Pure. Source: engine/wind/model.md W22.
double blend_group_delay_s(double frequency_hz, double interval_s, double averaging_s) noexcept;

}  // namespace yuragi::wind::blend
