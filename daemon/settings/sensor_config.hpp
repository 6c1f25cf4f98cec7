#pragma once

#include <optional>
#include <string>

#include "daemon/settings/wind_config.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/blend/blend_settings.hpp"
#include "engine/wind/judging/calibration.hpp"
#include "engine/wind/judging/reading_judge.hpp"

namespace yuragi {

/// Above the ground.
struct SensorHeights {
  std::optional<double> sensor_m{};  ///< none: it is not known
  double scene_m = 10.0;             ///< the height whose wind moves the scenes
};

/// The values of a sensor's tables under their names: what writes a configuration, or changes one, reads them.
struct SensorTables {
  ParameterValues calibration;  ///< calibration_parameters()
  ParameterValues judge;        ///< judge_parameters()
  ParameterValues blend;        ///< sensor_blend_parameters()
};

/// A sensor of an installation, as parse_config() or default_sensor() makes it.
struct SensorConfig {
  std::string name;
  const DriverDescription* driver = nullptr;
  ParameterValues values{};  ///< the driver's own, which it reads when it makes the sensor
  std::string origin{};      ///< `file:line:column` of its entry; empty where no file has it

  Calibration calibration{};             ///< [sensor.calibration], heights and all
  SensorHeights heights{};               ///< what its height_factor comes from
  std::optional<JudgeSettings> judge{};  ///< [sensor.judge]; none: every reading is believed
  bool is_compared = false;              ///< [sensor.judge] with the other sensors
  BlendSourceSettings blend{};           ///< [sensor.blend]; its length_m by the sensor's height, or 0

  SensorTables by_name{};  ///< what these members were made of
};

/// How far the gusts of a sensor reach, until it tells more of them itself, m: [wind] default_length where it is set;
/// or as its height says; or as far as the default wind's. Pure.
double gust_length_m(const WindConfig& wind, const SensorConfig& sensor) noexcept;

/// What the height of a sensor says of that, m: 8.1 * 0.7 times it up to 60 m (IEC 61400-1), at least kShortestGusts_m.
/// Where the calibration brings the speeds to another height, the length goes with them: what is measured goes on
/// passing the sensor in the same time. Pure.
double gust_length_at_height_m(double height_m, const Calibration& calibration) noexcept;

/// Of the values of calibration_parameters(). The error names the key that it is about.
Result<Calibration, ParameterError> calibration_of(const ParameterValues& values);
SensorHeights sensor_heights_of(const ParameterValues& values);

/// Of the values of judge_parameters(): how strictly the sensor's readings are judged, none where they are not; and
/// whether they are compared with the other sensors'.
std::optional<JudgeSettings> judge_settings_of(const ParameterValues& values);
bool is_compared(const ParameterValues& values);

}  // namespace yuragi
