#pragma once

#include "engine/base/state_pass.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind {

/// The direction of the wind for cameras with a wind_angle, which changes slowly. It follows the mean direction of the
/// last 10 minutes, as a vector mean: it does not change until that is more than 10 degrees away; then it turns toward
/// it by at most 0.5 degrees a second. It is held in less than 1 m/s and while no sensor is live. Only the first live
/// wind, if it comes within 10 s, is used at once, so that a film begins at the right side.
///
/// Pure: time is a parameter; the same steps give the same bits. Always finite. Thread-safe: no. Realtime-safe: yes.
class ViewWind {
 public:
  static constexpr double kMean_s = 600.0;
  static constexpr double kDeadBand_deg = 10.0;
  static constexpr double kMaxTurn_deg_s = 0.5;
  static constexpr double kMinSpeed_m_s = 1.0;
  static constexpr double kStart_s = 10.0;

  /// `from_deg`: the wind direction as long as no sensor is live; a value that is not finite counts as north.
  explicit ViewWind(double from_deg) noexcept;

  /// Advances by dt_s. `is_live`: the wind comes from a sensor.
  void advance(double dt_s, Vector wind, bool is_live) noexcept;

  /// Where the wind comes from, degrees clockwise from north, [0, 360).
  double from_deg() const noexcept { return from_deg_; }

  void list_state(StatePass& pass) {
    pass.within(from_deg_, 0.0, 360.0);
    pass(mean_, live_s_, age_s_, is_turning_);
  }

 private:
  double from_deg_;
  Vector mean_;
  double live_s_ = 0.0;  // duration of the mean, at most kMean_s
  double age_s_ = 0.0;   // at most a little above kStart_s
  bool is_turning_ = false;
};

}  // namespace yuragi::wind
