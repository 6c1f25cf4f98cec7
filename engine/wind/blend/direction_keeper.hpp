#pragma once

#include <cstddef>

#include "engine/base/state_pass.hpp"
#include "engine/wind/wind_reading.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::blend {

/// The direction of a source's wind, as a unit vector: that of its vane, held in a calm and smoothed if it is coarse.
///
/// A reading without a direction keeps the last one, or uses a given one. In a calm (below 0.5 m/s) a vane is
/// unreliable: the direction is held, more strongly the calmer it is (engine/wind/model.md W37). A vane of 8 or 16
/// points jumps: its directions are low-passed at the frequency above which its quantisation noise is stronger than the
/// turbulence (W31). All turns are by the shorter angle. Thread-safe: no. Realtime-safe: yes.
class DirectionKeeper {
 public:
  /// `step_deg`: resolution of the vane; 0: detected from the differences of its readings.
  explicit DirectionKeeper(double step_deg) : given_step_deg_(step_deg) {}

  /// Takes a reading, `dt_s` after the one before. `otherwise` is the direction for a source that has never sent any,
  /// and, if `otherwise_is_live`, for every reading without one. Returns a unit vector, downwind.
  Vector take(const Reading& reading, double dt_s, Vector otherwise, bool otherwise_is_live) noexcept;

  /// Did the last reading have a direction?
  bool has_vane() const noexcept { return has_vane_; }

  /// The step of the vane, degrees; 0: a fine one, or too little seen.
  double step_deg() const noexcept;
  bool is_coarse() const noexcept { return step_deg() >= kCoarse_deg; }

  /// The time constant of the smoothing; 0 for a fine vane.
  double memory_s() const noexcept { return memory_s_; }

  /// Sets it from the turbulence (W31): to the frequency at which quantisation noise and the fluctuation of the
  /// direction have the same density. That noise is step^2 / 12 (Bennett 1948), spread over the frequencies that
  /// readings every `interval_s` can have, or, if the fluctuation covers less than the steps, over those of the gusts
  /// (Widrow 1961: by its characteristic function). The fluctuation is in von Karman's inertial range, of deviation
  /// `swing_rad` and time scale `time_scale_s`.
  void expect(double swing_rad, double time_scale_s, double interval_s) noexcept;

  void list_state(StatePass& pass) {
    pass.unit_vector(toward_.u_m_s, toward_.v_m_s);
    pass(is_known_, has_vane_, memory_s_, last_deg_, turns_of_16_, turns_of_8_, was_fine_);
  }

 private:
  static constexpr double kCoarse_deg = 15.0;

  void note_step(double direction_deg) noexcept;

  double given_step_deg_;
  Vector toward_{0.0, 1.0};
  bool is_known_ = false;
  bool has_vane_ = false;
  double memory_s_ = 0.0;

  double last_deg_ = -1.0;
  std::size_t turns_of_16_ = 0;  ///< consecutive turns by whole steps of 1/16
  std::size_t turns_of_8_ = 0;
  bool was_fine_ = false;  ///< has made others
};

/// A unit vector turned toward another by a part (0 to 1) of the smaller angle between them.
Vector turned_toward(Vector unit, Vector other, double part) noexcept;

}  // namespace yuragi::wind::blend
