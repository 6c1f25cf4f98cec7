#pragma once

#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::wind::judging {

/// One point of a calibration curve: a reading of `measured_m_s` means a wind of `true_m_s`.
struct CalibrationPoint {
  double measured_m_s = 0.0;
  double true_m_s = 0.0;
};

/// From a sensor's reading to the wind at the scene's height: speed * unit * gain + offset, then the curve, then the
/// change of the wind with height; direction + north offset (engine/wind/model.md W32). The default changes nothing.
///
/// A reading of 0 stays 0: a cup that stands still does not reveal its offset. The gust is converted like the speed.
/// Thread-safe: yes. Realtime-safe: applied_to() is.
struct Calibration {
  double unit_m_s = 1.0;  ///< size of the sensor's unit, if its driver takes it for m/s
  double gain = 1.0;
  double offset_m_s = 0.0;
  std::vector<CalibrationPoint> curve{};  ///< from parse_calibration_curve(); extrapolated linearly
  double north_offset_deg = 0.0;          ///< clockwise; the true direction of the sensor's mark
  double height_factor = 1.0;             ///< height_factor(): from the sensor's height to the scene's

  Reading applied_to(const Reading& reading) const noexcept;
};

/// The reading in m/s (after its unit) that the calibration maps to 0: the zero of its straight line. Can be negative.
/// Thread-safe and realtime-safe: yes.
double zero_point_m_s(const Calibration& calibration) noexcept;

/// Points "measured:true" in m/s, separated by blanks: "0:0 5:5.2 12:12.9". At least two, both numbers rising from each
/// to the next. An empty text is no curve. The failure's text states what is allowed.
Result<std::vector<CalibrationPoint>, Failure> parse_calibration_curve(std::string_view text);

/// How much stronger the wind is at `to_m` than at `from_m` above the ground, by the logarithmic profile over ground of
/// this roughness; heights at or below it count as ten times it. Above 0. Thread-safe and realtime-safe: yes.
double height_factor(double from_m, double to_m, double roughness_m) noexcept;

}  // namespace yuragi::wind::judging
