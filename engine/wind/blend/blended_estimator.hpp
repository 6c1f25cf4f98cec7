#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "engine/base/state_pass.hpp"
#include "engine/wind/blend/blend_settings.hpp"
#include "engine/wind/blend/gust_reach_fit.hpp"
#include "engine/wind/blend/mean_wind_plane.hpp"
#include "engine/wind/blend/pen_places.hpp"
#include "engine/wind/blend/source_choice.hpp"
#include "engine/wind/blend/source_estimator.hpp"
#include "engine/wind/ground/ground_wind.hpp"
#include "engine/wind/ground/wind_stroke.hpp"
#include "engine/wind/source_report.hpp"
#include "engine/wind/turbulence/gust_noise.hpp"
#include "engine/wind/turbulence/gust_variances.hpp"
#include "engine/wind/wind_state.hpp"

namespace yuragi::wind::blend {

/// The wind that moves things: the live signal in the bands that the sensors resolve, noise of the same spectrum in the
/// others, without counting power twice.
///
/// In each octave band of frequency the sensor's readings have a weight a: 1 far below the crossover of 0.25 / its
/// interval (where sensor and noise have the same power), 0 far above, less the longer it is silent. The noise has the
/// rest *in power*, sqrt(1 - |a A|^2), A being the response of the sensor's own averaging and of the holding of its
/// readings in that band, and the strength that von Karman's spectrum has there; its turbulence intensity and length
/// are fitted to past readings, and return to the climate's if there are none (engine/wind/model.md W17 to W21). The
/// noise is read from a pattern that the mean wind carries over the ground (GustNoise) at the sensor's place, along the
/// wind and across it. A mean that is no longer measured fades into the climate's. All averages are of vectors; weights
/// are slewed by critically damped filters, so that nothing jumps.
///
/// Places: measured wind is written at the sensor's place (PenPlaces), which is at the windward edge of the scenes
/// unless its position is configured, and is carried from there by the mean wind: stroke() is the addition of a tick to
/// the tapes (WindTapes), ground() holds the strength of the noise that fills the rest. The state is the wind at that
/// place; of several places their mean, by the sensors' weights.
///
/// Several sources: SourceChoice selects and weights them. Those selected at one place share each band by weight times
/// trust (W23), so that a slow one dominates the mean and a fast one the gusts; a relative one supplies the unresolved
/// gusts, scaled to theirs. Sources at several places each have a tape of their own, and their means make a plane
/// (MeanWindPlane). A source without a vane contributes nothing across the wind, and one with 8 or 16 points only slow
/// fluctuations.
///
/// Delay: the sensor's part is later than the wind by half of its averaging time, half of the interval for which a
/// reading is held, and the group delay of the weighted bands, 0.36 to 0.2 of the interval: blend_group_delay_s(). For
/// means over the interval T, one after the other:
///
/// frequency times T to 0.02 0.05 0.1 0.2 0.25 (the crossover) delay over T 1.36 1.35 1.31 1.25 1.22
///
/// The state is finite for any input, and continuous: no reading, loss or return makes it jump. Time is a parameter and
/// must not go back (a call with an earlier time changes nothing). Thread-safe: no; one thread owns it. Realtime-safe
/// after construction: yes. Source: Taylor 1938, The spectrum of turbulence (frozen turbulence).
class BlendedEstimator {
 public:
  /// `noise`: shared with readers of the wind at other places. The climate's seed selects the place on it at which the
  /// gusts begin. Allocates.
  BlendedEstimator(std::size_t source_count, const Settings& settings,
                   std::shared_ptr<const turbulence::GustNoise> noise);

  /// Takes a reading of source `source` (below the count given at construction). An implausible one is ignored, and
  /// returns false.
  bool accept(std::size_t source, const Reading& reading) noexcept;

  /// Advances to `now` and returns the wind at the place of the measurement.
  State advance(MonoTime now) noexcept;

  /// The same wind over the ground, as of the last advance(); without tapes.
  /// Sets Settings::reach_m for other scenes. The windward edge moves there gradually, so that nothing jumps.
  /// Realtime-safe.
  void set_reach(double reach_m) noexcept { settings_.reach_m = reach_m; }

  const ground::Wind& ground() const noexcept { return ground_; }
  /// The addition of the last advance() to the tapes.
  const ground::WindStroke& stroke() const noexcept { return stroke_; }

  /// The state of `source`, as of the last advance(). A source that does not exist is silent.
  SourceReport report(std::size_t source) const noexcept;

  /// Returns the value as which the readings of `source` are used: the configured one, or the judged or assumed one if
  /// that is unknown.
  TakenValue taken(std::size_t source) const noexcept;

  /// Returns true if a source other than `besides` measures the direction of the wind that is shown. As of the last
  /// advance().
  bool is_direction_live(std::size_t besides) const noexcept;

  /// The reach of gusts at this site relative to the usual, as learnt from sensors at several places.
  const GustReach& reach() const noexcept { return reach_fit_.reach(); }
  /// Continues from an earlier run's result. Returns false, and changes nothing, if it is implausible.
  bool restore_reach(const GustReach& reach) noexcept { return reach_fit_.restore(reach); }

  /// The turbulence that is fitted at the moment, along the wind.
  turbulence::Turbulence turbulence() const noexcept;

  /// The remaining noise at the place of a sensor, where most is known.
  turbulence::GustNoise::Moment gusts_at(std::size_t pen) const noexcept;

  /// The site's spectrum included. What each advance() computes anew is left out. Sources may have been added at the
  /// end: they begin silent.
  void list_state(StatePass& pass);

 private:
  static constexpr std::size_t kBands = turbulence::OctaveFollower::kBands;
  static constexpr std::size_t kOctaves = turbulence::GustNoise::kOctaves;

  /// The shares of a source at the moment: of the mean, and of the bands among all sources together.
  struct Share {
    BandWeights weights{};  ///< of the mean (0) and each band (1 + band), among the selected sources
    double middle = 0.0;    ///< of the mean at the middle of the scenes
    double tilt = 0.0;      ///< the plane's addition there; it and the slopes follow the plane slowly
    double per_m_east = 0.0, per_m_south = 0.0;

    void list_state(StatePass& pass) { pass(weights, middle, tilt, per_m_east, per_m_south); }
  };

  /// The output at one place.
  struct Pen {
    std::vector<BandWeights> shares;   ///< for each source: of the mean, and of the bands at this place
    std::vector<BandWeights> written;  ///< limited to what the tape can hold
    double weight = 0.0;               ///< the sum of its sources' weights (SourceChoice)
  };

  /// The mean by all sources together, and its weight.
  struct MeasuredMean {
    Vector mean;
    double weight = 0.0;     ///< of the measured means; the climate's has the rest
    double speed_m_s = 0.0;  ///< slow mean
    double trust = 0.0;      ///< of the measurable bands: 1 while readings are on time
  };
  /// The part of the power at a frequency that comes from the sensors.
  struct Power {
    double along = 0.0, across = 0.0;
  };
  /// At a frequency: the share of the gusts from relative sources, and the part of the mean's share that no absolute
  /// source resolves and that they get.
  struct OpenPart {
    double gusts = 0.0;
    double given = 0.0;
  };

  void share_out(double dt_s) noexcept;
  void share_mean(double dt_s) noexcept;
  void share_bands() noexcept;
  double share_level(std::size_t level, std::span<const double> weights, std::span<double> shares) const noexcept;
  void share_at(std::size_t pen) noexcept;
  void learn_scales(double dt_s) noexcept;
  MeasuredMean measure_mean() noexcept;
  double trust() const noexcept;
  double newest_age_s() const noexcept;
  Vector level_of(std::size_t source, std::size_t level) const noexcept;
  void carry_gusts(const MeasuredMean& measured, double dt_s) noexcept;
  double gust_length_m(const MeasuredMean& measured) const noexcept;
  void place_pens() noexcept;
  void learn_reach(double dt_s) noexcept;
  void write_gusts() noexcept;
  void weigh_gusts(const MeasuredMean& measured, double dt_s) noexcept;
  void weigh_octave(std::size_t octave, const MeasuredMean& measured, float part) noexcept;
  Power measured_power(const turbulence::OctaveFollower::Response& bands,
                       std::span<const BandWeights> shares) const noexcept;
  void show(const MeasuredMean& measured) noexcept;
  OpenPart open_part(double frequency_hz, const MeasuredMean& measured) const noexcept;
  double variance_share(std::size_t source, const OpenPart& open, const MeasuredMean& measured) const noexcept;

  Settings settings_;
  Vector climate_;
  std::shared_ptr<const turbulence::GustNoise> noise_;
  turbulence::GustVariances climate_along_, climate_across_;
  std::vector<SourceEstimator> sources_;
  SourceChoice choice_;
  MeanWindPlane plane_;
  PenPlaces places_;
  std::vector<Pen> pens_;
  GustReachFit reach_fit_;
  ground::Wind ground_;
  ground::WindStroke stroke_;
  double advection_m_s_ = 0.0;
  State state_;
  double reach_m_ = 0.0;      ///< distance of the windward edge
  double last_step_s_ = 0.0;  ///< duration of the tick before the last
  bool has_begun_ = false;
  bool is_first_ = false;  ///< tick

  // Computed in each tick; for each source.
  std::vector<Share> shares_;
  std::vector<double> weights_, level_shares_;
  std::vector<PlaceWeights> place_weights_;
  std::vector<GustReachFit::Place> measured_places_;
  std::vector<SourceResponse> passed_;  ///< for the present octave
  std::vector<double> folded_;          ///< the power aliased to it, relative to the wind's own
  BandWeights fade_{};                  ///< the part of each band that the tape can hold
  bool is_fading_ = false;
};

}  // namespace yuragi::wind::blend
