#pragma once

#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind {

/// The direction of the wind that cameras with a wind_angle keep their angle to: calm enough to look from. It follows
/// the mean direction of the last 10 minutes, as a vector mean, and stays where it is until that is more than 10
/// degrees away; then it turns toward it by at most 0.5 degrees a second. It is held in less than 1 m/s and while no
/// sensor is live. Only the first live wind, if it comes within 10 s, is taken at once: a film begins at the right
/// side.
///
/// Pure: time is a parameter; the same steps give the same bits. Always finite. Thread-safe: no. Realtime-safe: yes.
class ViewWind {
 public:
  static constexpr double kMean_s = 600.0;
  static constexpr double kDeadBand_deg = 10.0;
  static constexpr double kMaxTurn_deg_s = 0.5;
  static constexpr double kMinSpeed_m_s = 1.0;
  static constexpr double kStart_s = 10.0;

  /// `from_deg`: where the wind comes from as long as no sensor is live; anything not finite counts as north.
  explicit ViewWind(double from_deg) noexcept;

  /// Advances by dt_s. Not live: the wind comes from no sensor.
  void advance(double dt_s, Vector wind, bool is_live) noexcept;

  /// Where the wind comes from, degrees clockwise from north, [0, 360).
  double from_deg() const noexcept { return from_deg_; }

 private:
  double from_deg_;
  Vector mean_;
  double live_s_ = 0.0;  // over which the mean goes, at most kMean_s
  double age_s_ = 0.0;   // at most a little above kStart_s
  bool is_turning_ = false;
};

}  // namespace yuragi::wind
