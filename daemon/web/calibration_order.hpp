#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/wind/judging/calibration.hpp"

namespace yuragi::daemon::web {

/// A calibration that a client wants: checked numbers, and names that are still to be looked up in the configuration.
struct CalibrationOrder {
  /// More readings are no better, and the command's lines stay few.
  static constexpr double kMaxDuration_s = 1800.0;

  std::string calibration = {};  ///< "zero", "span", "north" or "microphone"
  std::optional<double> duration_s = {};
  // What is known: one of these, but for zero none.
  std::optional<double> bearing_deg = {};
  std::optional<double> speed_m_s = {};
  std::vector<wind::judging::CalibrationPoint> points = {};  ///< measured before
  std::string reference = {};                                ///< the name of another sensor
};

/// The words behind `yuragi calibrate` that carry it out for a sensor: each value is joined to its option by "=", so
/// that no name can be taken for an option. Pure.
std::vector<std::string> words_of(const CalibrationOrder& order, const std::string& sensor);

/// The values that a calibration has found, and those that it began from, by their names in page_calibration_keys(); as
/// they are typed after "KEY = ".
struct FoundCalibration {
  using Values = std::vector<std::pair<std::string, std::string>>;
  Values before = {}, after = {};
};

}  // namespace yuragi::daemon::web
