#pragma once

#include <array>
#include <complex>
#include <memory>

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

/// Turbulence is measured as a part of the mean speed; of a weaker mean than this it is none.
inline constexpr double kMinSpeed_m_s = 0.5;

/// A number for the mean (0) and each octave band (1 + band) of a source.
using BandWeights = std::array<double, turbulence::OctaveFollower::kBands + 1>;

/// A complex response along the wind and across it.
struct SourceResponse {
  std::complex<double> along, across;
};

/// The prior of a source's turbulence, before it has sent readings. Pure.
turbulence::TurbulencePrior turbulence_prior(const BlendSettings& blend, const BlendSourceSettings& settings) noexcept;

/// One source of a blend: its readings split into octave bands (engine/wind/model.md W17), the weight of each band
/// (W18, W21), and the turbulence fitted to its readings (W28, W29). Thread-safe: no. Realtime-safe after construction:
/// yes.
class BlendSource {
 public:
  BlendSource(const BlendSettings& blend, const BlendSourceSettings& settings, const turbulence::GustNoise& noise);

  /// What a source without a vane needs to know, and the fit.
  struct Around {
    WindVector ahead{0.0, 1.0};      ///< unit vector downwind
    bool is_direction_live = false;  ///< another source measures it
    double advection_m_s = 1.0;      ///< how fast gusts pass
  };

  /// Takes a reading; false for one that is impossible, a maximum, or older than what is known.
  bool accept(const WindReading& reading, const Around& around) noexcept;

  /// Advances to `now`. Precondition: it has sent a reading.
  void step(MonoTime now, double dt_s, const turbulence::OctaveFollower::Parts& parts) noexcept;

  /// What its readings are taken as; never of kUnknown.
  TakenValue taken() const noexcept {
    return {.value = taken_, .is_judged = measured_.verdict() != ReadingValue::kUnknown};
  }

  const SourceRecord& record() const noexcept { return record_; }
  bool has_vane() const noexcept { return direction_.has_vane(); }
  bool is_coarse() const noexcept { return direction_.is_coarse(); }

  WindVector mean() const noexcept { return follower_.mean(); }
  WindVector band(std::size_t band) const noexcept { return follower_.band(band); }
  double speed_m_s() const noexcept { return speed_m_s_; }  ///< slow mean of its speeds

  /// The weights of the mean and of each band, 0 to 1, slewed; and those that it has while its readings are on time.
  const BandWeights& trust() const noexcept { return trust_; }
  const BandWeights& full_trust() const noexcept { return full_trust_; }
  /// What its averaging and the holding of its readings leave of a wave in the middle of each band.
  const BandWeights& passed() const noexcept { return passed_; }

  /// Its frequency response (W19): what averaging, the holding of readings and its vane leave of a wave of the real
  /// wind. Times the response of its bands (OctaveFollower::Response) it is the source's part of the blend.
  SourceResponse passed_of(double frequency_hz) const noexcept;
  /// How much later than the wind its readings are: half of what one averages over, and half of what it is held for.
  double reading_delay_s() const noexcept { return 0.5 * (averaging_s() + expected_interval_s()); }
  /// The power that is folded onto this frequency, over the wind's own there (W40): 0 of means.
  double folded_over_own(double frequency_hz) const noexcept {
    return taken_ == ReadingValue::kInstant ? 1.0 / unfolded_.at(frequency_hz) - 1.0 : 0.0;
  }
  /// The weight of a wave of this frequency while readings are on time (W18, W40).
  double trust_at(double frequency_hz) const noexcept;

  const turbulence::Turbulence& turbulence() const noexcept { return turbulence_; }  ///< along the wind
  const turbulence::GustVariances& along() const noexcept { return along_; }
  const turbulence::GustVariances& across() const noexcept { return across_; }

  RelativeScale scale;  ///< of a relative source

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
  void measure(WindVector ahead, double mean_of_s) noexcept;
  void fit(double interval_s, double advection_m_s) noexcept;

  BlendSourceSettings settings_;
  ReadingValue taken_;  ///< not kUnknown
  double mean_memory_s_;
  const turbulence::GustNoise* noise_;

  SourceRecord record_;
  DirectionKeeper direction_;
  WindVector wind_;  ///< that is held
  turbulence::OctaveFollower follower_;
  std::array<math::CriticallyDamped, turbulence::OctaveFollower::kBands + 1> trusts_{};
  BandWeights trust_{}, full_trust_{}, passed_{};
  UnfoldedPart unfolded_;
  double interval_s_ = 0.0;  ///< that the full trust is made for
  double speed_m_s_ = 0.0;
  double measured_s_ = 0.0;  ///< for so long, at most the memory of that speed

  turbulence::WindTurbulence measured_;
  turbulence::Turbulence turbulence_;
  turbulence::GustVariances along_, across_;  ///< what each octave of the noise has of it
  std::shared_ptr<turbulence::SiteSpectrum> site_;
  SiteSpectrumFit site_fit_;
  std::size_t since_kept_ = 0;  ///< readings
  double fitted_s_ = 0.0;       ///< time since the last fit
};

/// The group delay of the blend, s: how much later than the wind the part of it at this frequency is that comes from a
/// source that sends a reading every `interval_s`, each the mean over `averaging_s`. Pure. Source:
/// engine/wind/model.md W22.
double blend_group_delay_s(double frequency_hz, double interval_s, double averaging_s) noexcept;

}  // namespace yuragi::wind::blend
