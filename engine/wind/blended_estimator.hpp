#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/math/critically_damped.hpp"
#include "engine/wind/gust_noise.hpp"
#include "engine/wind/octave_follower.hpp"
#include "engine/wind/source_record.hpp"
#include "engine/wind/synthetic_wind.hpp"
#include "engine/wind/turbulence_fit.hpp"
#include "engine/wind/wind_estimator.hpp"

namespace yuragi {

struct BlendSettings {
  SyntheticWindSettings climate;  ///< the wind where nobody measures: mean, direction, turbulence intensity, seed
  double length_m = 57.0;         ///< how far its gusts reach: the integral length scale
  double handover_s = 3.0;        ///< about how long the way from one source to another takes
  double stale_intervals = 5.0;   ///< silent for this many of its own intervals: stale
  double fit_memory_s = 600.0;    ///< how long the fit of the turbulence remembers
  double mean_memory_s = 600.0;   ///< how fast the mean of a silent sensor fades into the climate's
  double rate_hz = 60.0;          ///< how often the wind is shown: gusts too quick for that are left out
};

/// The wind that moves things: the live signal where the sensors know, noise of the same spectrum where they do not,
/// counted once.
///
/// In each octave band of frequency the sensor's word has a weight a: 1 far below the crossover of 0.25 / its interval
/// (where sensor and noise have the same power), 0 far above, less the longer it is silent. The noise has the rest *in
/// power*, sqrt(1 - |a A|^2), A being what the sensor's own averaging and the holding of its readings leave of that
/// band, and the strength that von Karman's spectrum has there; its turbulence intensity and length are fitted to the
/// readings of the past, and go back to the climate's while nothing is known. The noise is read from a pattern that the
/// mean wind carries over the ground (GustNoise) at the sensor's place, along the wind and across it. A mean that
/// nobody measures fades into the climate's. Everything is made of vectors; weights slew by critically damped filters,
/// so nothing jumps. Source: method of the wind model (`wind.md` 2 of the specification), Taylor 1938 (frozen
/// turbulence).
class BlendedEstimator final : public WindEstimator {
 public:
  /// `noise`: shared with whoever wants to know the wind at other places. The climate's seed says where on it the gusts
  /// begin. Allocates.
  BlendedEstimator(std::size_t source_count, const BlendSettings& settings, std::shared_ptr<const GustNoise> noise);

  bool accept(std::size_t source, const WindReading& reading) noexcept override;
  WindState advance(MonoTime now) noexcept override;
  const GroundWind& ground() const noexcept override { return ground_; }
  SourceReport report(std::size_t source) const noexcept override;

  /// The turbulence that is fitted at the moment, along the wind.
  Turbulence turbulence() const noexcept;

 private:
  static constexpr std::size_t kBands = OctaveFollower::kBands;
  static constexpr std::size_t kOctaves = GustNoise::kOctaves;
  using Shares = std::array<double, kOctaves>;

  /// One component of a source's wind: its turbulence, and the variance of each octave of the noise over the square of
  /// the mean speed.
  struct Component {
    TurbulenceFit fit;
    Shares shares;
  };

  struct Source {
    Source(const BlendSettings& settings, const Shares& along_shares, const Shares& across_shares);

    SourceRecord record;
    OctaveFollower follower;
    std::array<CriticallyDamped, kBands> trust{};  ///< in each band, at most what its interval allows
    CriticallyDamped mean_trust, weight;
    std::array<double, kBands> shares{};  ///< weight times trust, as of this tick; in each band
    double mean_share = 0.0;              ///< the same of the mean
    double interval_s = 0.0;              ///< expected, as of this tick
    double speed_m_s = 0.0;               ///< slow mean of its speeds
    Component along, across;
    std::vector<WindVector> history;  ///< a ring of the last readings
    std::size_t history_size = 0;     ///< those without a gap up to the last
    std::size_t next = 0;
    double fitted_s = 0.0;  ///< time since the last fit
  };

  /// What all sources together say, and how far it is to be believed.
  struct Heard {
    WindVector wind;
    WindVector mean;
    double weight = 0.0;     ///< of the means that are measured; the climate's has the rest
    double speed_m_s = 0.0;  ///< slow mean
    double trust = 0.0;      ///< of the bands that can be known: 1 while the sensors speak
  };

  void learn(Source& source) noexcept;
  void measure_scales(Source& source) noexcept;
  Source* choose() noexcept;
  void follow(Source& source, bool is_chosen, double dt_s) noexcept;
  Heard hear() const noexcept;
  void carry_gusts(const Heard& heard, double dt_s) noexcept;
  void weigh_gusts(const Heard& heard) noexcept;
  double power_heard(double frequency_hz) const noexcept;
  Shares shares_of(double intensity, double length_m) const noexcept;

  BlendSettings settings_;
  WindVector climate_;
  std::shared_ptr<const GustNoise> noise_;
  Shares climate_along_, climate_across_;
  std::vector<Source> sources_;
  GroundWind ground_;
  double advection_m_s_ = 0.0;
  WindState state_;
  bool has_begun_ = false;
};

}  // namespace yuragi
