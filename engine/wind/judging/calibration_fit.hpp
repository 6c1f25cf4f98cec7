#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/wind/judging/calibration.hpp"

namespace yuragi::wind::judging {

// Fits a calibration: from a sensor's readings beside a reference to gain, offset, curve and north offset
// (engine/wind/model.md W34). The sensor's speeds are in m/s: its unit is applied, nothing else of its calibration.
// Each function refuses data that would make a calibration worse than none; the failure's text states what to do. All
// are pure; thread-safe: yes; realtime-safe: no.

// ---- zero ----

/// A sensor in still air.
struct StillAir {
  std::size_t count = 0;
  double mean_m_s = 0.0;
  double noise_m_s = 0.0;  ///< standard deviation
};

/// Refuses fewer than 10 readings, more scatter or drift than in still air, and an implausible zero error.
Result<StillAir, Failure> measure_still_air(std::span<const double> indicated_m_s);

/// The offset with which `calibration` maps `still_m_s` to 0; its gain and curve do not change.
double offset_for_zero_m_s(const Calibration& calibration, double still_m_s) noexcept;

// ---- north ----

/// The mean of directions as unit vectors, so that 350 and 10 degrees have the mean 0.
struct DirectionMean {
  std::size_t count = 0;
  double mean_deg = 0.0;    ///< clockwise, [0, 360)
  double spread_deg = 0.0;  ///< circular standard deviation, sqrt(-2 ln R) (Mardia and Jupp 2000, eq. 2.3.11)
};

/// Of any directions, degrees; all fields are 0 without directions.
DirectionMean direction_mean(std::span<const double> directions_deg) noexcept;

/// The direction of a vane that is held by hand. Refuses fewer than 5 readings, and a vane that moved.
Result<DirectionMean, Failure> measure_held_vane(std::span<const double> indicated_deg);

/// The turn between two vanes in the same wind, from the angles sensor to reference, degrees. Refuses fewer than 20,
/// and vanes that do not turn together.
Result<DirectionMean, Failure> measure_turn(std::span<const double> turns_deg);

/// A direction at a time, s; the origin is the caller's.
struct TimedDirection {
  double time_s = 0.0;
  double direction_deg = 0.0;
};

/// Two vanes side by side: the turn from the mean of the one to the mean of the other in each block of `block_s` in
/// which both have readings, degrees in (-180, 180].
std::vector<double> pair_turns(std::span<const TimedDirection> indicated, std::span<const TimedDirection> truth,
                               double block_s);

/// The same angle in (-180, 180].
double signed_degrees(double angle_deg) noexcept;

// ---- span ----

/// true = gain * reading + offset, and how well it fits.
struct LineFit {
  std::size_t count = 0;
  double gain = 1.0;
  double offset_m_s = 0.0;
  double r_squared = 1.0;     ///< part of the variance of the true speeds that the line explains
  double residual_m_s = 0.0;  ///< root mean square distance of the true speeds from the line
};

/// Least squares over pairs; those with a reading of 0 are ignored. Refuses fewer than two speeds, less than 2 m/s
/// between the slowest and the fastest, an implausible gain, and pairs that do not fit a line.
Result<LineFit, Failure> fit_line(std::span<const CalibrationPoint> pairs);

/// The line through one pair and the zero point of the calibration until now. Refuses a wind below 2 m/s, and a gain
/// that no sensor has.
Result<LineFit, Failure> fit_line_from_zero(double zero_m_s, const CalibrationPoint& pair);

/// A curve by the method of bins, as IEC 61400-12-1 averages power curves: pairs are averaged in bins of the
/// reading, and bins that do not rise are joined.
struct CurveFit {
  std::vector<CalibrationPoint> curve;
  double r_squared = 1.0;
  double residual_m_s = 0.0;
};

/// Bins of 1 m/s with at least 3 pairs each; a point beyond either end has the slope of that half of the pairs. Refuses
/// like fit_line(), and fewer than 3 bins.
Result<CurveFit, Failure> fit_curve(std::span<const CalibrationPoint> pairs);

/// A speed at a time, s; the origin is the caller's.
struct TimedSpeed {
  double time_s = 0.0;
  double speed_m_s = 0.0;
};

/// Two sensors side by side: means over blocks of `block_s`, for blocks in which both have readings. In the order of
/// time.
std::vector<CalibrationPoint> pair_means(std::span<const TimedSpeed> indicated, std::span<const TimedSpeed> truth,
                                         double block_s);

}  // namespace yuragi::wind::judging
