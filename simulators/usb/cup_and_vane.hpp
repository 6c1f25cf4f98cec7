#pragma once

#include <cstdint>

#include "simulators/core/played_wind.hpp"

namespace yuragi::simulators::usb {

/// A cup and a vane in the played wind, wired to a counter and an analogue input:
///
///   cup    one pulse for each 0.1 m of wind that has passed
///   vane   a potentiometer between ground and 5 V, whose track begins at north, runs clockwise and covers 356 degrees;
///   in the remaining 4 degrees a resistor pulls the input to 5.5 V, outside of the track's range
///
/// Thread-safe: no.
class CupAndVane {
 public:
  static constexpr double kMetresPerPulse = 0.1;
  static constexpr double kReference_v = 5.0;
  static constexpr double kTrack_deg = 356.0;
  static constexpr double kOpenWiper_v = 5.5;

  /// Advances to `time_s`, which must not decrease. A jammed cup makes no pulses, and the vane does not turn.
  void advance(double time_s, const core::PlayedMoment& wind, bool is_jammed);

  /// Pulses since the start.
  std::uint64_t pulses() const noexcept;
  double wiper_v() const noexcept { return wiper_v_; }

 private:
  double time_s_ = 0.0;
  double passed_m_ = 0.0;
  double wiper_v_ = 0.0;
};

}  // namespace yuragi::simulators::usb
