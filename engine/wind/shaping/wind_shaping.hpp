#pragma once

#include <memory>
#include <optional>
#include <span>

#include "engine/base/state_pass.hpp"
#include "engine/math/critically_damped.hpp"
#include "engine/wind/ground/ground_wind.hpp"
#include "engine/wind/shaping/soft_ceiling.hpp"
#include "engine/wind/shaping/speed_memory.hpp"
#include "engine/wind/turbulence/gust_variances.hpp"
#include "engine/wind/wind_state.hpp"

namespace yuragi::wind::shaping {

/// The target speeds of a site's own wind: its 50th and its 95th percentile.
struct SiteRange {
  double median_m_s = 0.0;  ///< 0: no site gain
  double strong_m_s = 0.0;  ///< 0: the median's gain for every wind; otherwise above median_m_s
  double most_gain = 3.0;   ///< at least 1; gains are at least 1 / most_gain
};

struct WindShapingSettings {
  double floor_m_s = 0.0;  ///< the minimum mean speed; 0: none
  SiteRange site = {};
  double site_memory_s = 7.0 * 86400.0;  ///< of the site's speeds
  double over_s = 120.0;                 ///< how long floor and site gain take to follow the wind's mean
  double gusts = 1.0;                    ///< factor on the real gusts, 0 to 3
  SoftCeiling ceiling = {};
  double closed_level = 0.0;          ///< outside of opening hours, 0 to 1: the part of the wind that is left
  double fade_s = 300.0;              ///< how long opening and closing take
  double turbulence_intensity = 0.3;  ///< of the breeze that the floor adds to a still wind
  double length_m = 57.0;             ///< and its integral length scale
};

/// A wind that a person has set.
struct HeldWind {
  double speed_m_s = 0.0;      ///< its mean
  double direction_deg = 0.0;  ///< where it comes from
};

/// What people have set by hand.
struct ByHand {
  std::optional<HeldWind> wind = std::nullopt;  ///< moves the scenes in place of the real wind
  bool is_dark = false;                         ///< openness is 0, whatever the opening hours are; no wind changes
};

/// The active effects, as of the last shape().
struct WindShapingReport {
  double mean_m_s = 0.0;         ///< slow mean of the real wind
  double shaped_mean_m_s = 0.0;  ///< the mean after site gain and floor
  double site_gain = 1.0;
  double floor_gain = 1.0;
  double breeze_m_s = 0.0;  ///< what the floor adds
  double gusts = 1.0;       ///< how strong the gusts are, compared with the real ones
  double opening = 1.0;     ///< the factor on the wind: closed_level when closed, 1 when open
  double openness = 1.0;    ///< 0 when closed or dark by hand, 1 when open, for any closed_level
  double hand = 0.0;        ///< the part of the wind that is set by hand
  double speed_m_s = 0.0;   ///< of the wind at this moment, before the ceiling
  double ceiling_gain = 1.0;
  double median_m_s = 0.0;  ///< the site's own, from its memory
  double strong_m_s = 0.0;
  double known_s = 0.0;  ///< time that is remembered
};

/// From the real wind to the one that moves the scenes: for days without wind, storms and nights.
///
///  1. Site gain: the wind is made stronger or weaker by a factor that takes the site's median to `site.median_m_s`
///     and its 95th percentile to `site.strong_m_s`; between the two the mean is interpolated linearly, and beyond them
///     the factor is constant. It grows from 1 during the first hours of live wind, and is 1 for the default wind.
///  2. Floor: a mean below it is raised to it by a factor of up to kMaxFloorGain; the rest is a breeze from the last
///  wind direction, with the turbulence of the climate at that level. It carries the gusts: those that no sensor
///  measured then differ from the real wind's.
///  3. Opening: outside of opening hours only a part remains. 4. By hand: while a person has set a wind, it takes the
///  place of all others, also when closed: its mean is the same everywhere, with the turbulence of the climate at its
///  speed. 5. Ceiling: SoftCeiling at the place of measurement. Its factor is written on the tapes with the wind, so
///  that a limited gust crosses the ground unchanged.
///
/// A factor never turns the wind. Site gain, floor, opening and hand are slow, critically damped: they never jump for
/// any wind, clock, `is_open` or hand. A step that is off does not change the wind, bit for bit; after a wind by hand
/// the noise has been carried farther. Finite for a finite wind.
/// Thread-safe: no. Realtime-safe: all but construction.
class WindShaping {
 public:
  static constexpr double kMaxFloorGain = 3.0;
  static constexpr double kChangeOver_s = 5.0;  ///< how long change() takes
  static constexpr double kHandOver_s = 5.0;    ///< how long the wind takes to one set by hand, and back
  static constexpr double kDarkOver_s = 2.0;    ///< how long going dark takes, and back

  /// `noise`: the one that the estimator and the scenes have.
  WindShaping(const WindShapingSettings& settings, std::shared_ptr<const turbulence::GustNoise> noise);

  /// Shapes the wind of wind.state.time. A time that goes back counts as no passed time. The first call starts at the
  /// targets for its wind and `is_open`. `is_of_site`: live wind is the site's, and is remembered.
  void shape(ground::DrivingWind& wind, bool is_open, bool is_of_site = true, const ByHand& by_hand = {}) noexcept;

  /// Changes the settings, over the next seconds (kChangeOver_s): the memory of the site is kept, and nothing jumps.
  /// Turbulence and length of the breeze do not change. Realtime-safe: yes.
  void change(const WindShapingSettings& settings) noexcept;

  const WindShapingSettings& settings() const noexcept { return settings_; }
  WindShapingReport report() const noexcept;

  /// The site's speeds (slow means of the live wind), for saving over a restart, and for restoring before the first
  /// shape().
  const SpeedMemory& memory() const noexcept { return memory_; }
  bool restore(std::span<const double> times_s) noexcept;

  void list_state(StatePass& pass);

 private:
  /// The settings that act at once, at the present progress of a change.
  struct Strengths {
    double floor_m_s = 0.0;
    double gusts = 1.0;
    double per_ceiling_from_s_m = 0.0, per_ceiling_most_s_m = 0.0;  ///< 1 over a speed; 0: no ceiling

    void list_state(StatePass& pass) { pass(floor_m_s, gusts, per_ceiling_from_s_m, per_ceiling_most_s_m); }
  };
  static Strengths strengths_of(const WindShapingSettings& settings) noexcept;

  void change_strengths(double dt_s) noexcept;
  void remember(double mean_m_s, double dt_s) noexcept;
  void look_at_memory() noexcept;
  double site_gain_of(double mean_m_s) const noexcept;
  void follow(double live_weight, bool is_open, double dt_s) noexcept;
  void apply_gains(ground::DrivingWind& wind) const noexcept;
  void add_breeze(ground::DrivingWind& wind, double dt_s) noexcept;
  void follow_hand(const ByHand& by_hand, double dt_s, double way_s) noexcept;
  void apply_hand(ground::DrivingWind& wind, double dt_s) noexcept;
  void hold_back(ground::DrivingWind& wind) noexcept;

  WindShapingSettings settings_;
  Strengths from_, now_;                ///< before a change, and at its present progress
  math::CriticallyDamped change_{1.0};  ///< progress of the change
  SoftCeiling ceiling_;                 ///< of now_
  std::shared_ptr<const turbulence::GustNoise> noise_;
  turbulence::GustVariances along_, across_;  ///< of the breeze
  SpeedMemory memory_;
  double live_s_ = 0.0;      ///< duration of the sensors' wind
  double unstored_s_ = 0.0;  ///< time since the memory was updated
  double median_m_s_ = 0.0, strong_m_s_ = 0.0, known_s_ = 0.0;
  math::CriticallyDamped mean_, quick_mean_;  ///< of the real wind's speed
  math::CriticallyDamped site_{1.0}, floor_{1.0}, breeze_, opening_{1.0}, openness_{1.0};
  Vector blown_m_;                                   ///< distance by which the breeze has also carried the gusts
  double blown_way_m_ = 0.0;                         ///< and along how much of a way
  math::CriticallyDamped hand_, dark_;               ///< how much of each is in effect, 0 to 1
  math::CriticallyDamped hand_m_s_, hand_from_deg_;  ///< the wind by hand; any number of full turns
  double hand_turn_rad_ = 0.0;                       ///< from the real wind's direction to its own, without a jump
  Vector hand_blown_m_;                              ///< distance by which it has carried the gusts, and along how ...
  double hand_way_m_ = 0.0;                          ///< ... much of a way
  double speed_m_s_ = 0.0, ceiling_gain_ = 1.0;
  MonoTime time_{};
  bool has_begun_ = false;
};

}  // namespace yuragi::wind::shaping
