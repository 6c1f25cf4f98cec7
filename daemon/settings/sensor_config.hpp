#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "daemon/settings/table_of.hpp"
#include "daemon/settings/wind_config.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/base/parameter.hpp"
#include "engine/wind/blend/blend_settings.hpp"
#include "engine/wind/judging/calibration.hpp"
#include "engine/wind/judging/reading_judge.hpp"

namespace yuragi::daemon::settings {

/// Heights above the ground.
struct SensorHeights {
  std::optional<double> sensor_m{};  ///< none: unknown
  double scene_m = 10.0;             ///< the height whose wind moves the scenes
};

/// Replaces a sensor if a recording is replayed as it was.
struct StandIn {
  std::filesystem::path recording;
  std::function<std::unique_ptr<drivers::sensor::Sensor>()> open;
};

/// A sensor of an installation, as parse_config() or default_sensor() makes it.
struct SensorConfig {
  std::string name;
  const drivers::sensor::DriverDescription* driver = nullptr;
  ParameterValues values{};  ///< the driver's own parameters
  std::string origin{};      ///< `file:line:column` of its entry; empty: it is in no file

  wind::judging::Calibration calibration{};             ///< [sensor.calibration], with the height factor
  SensorHeights heights{};                              ///< from which the height factor was computed
  std::optional<wind::judging::JudgeSettings> judge{};  ///< [sensor.judge]; none: every reading is believed
  bool is_compared = false;                             ///< [sensor.judge] with the other sensors
  wind::blend::SourceSettings blend{};   ///< [sensor.blend]; length_m from the height, 0 if that is unknown
  drivers::sensor::StatedValue value{};  ///< what its speed is, with the source; also in `blend`

  TablesByName by_name{};  ///< of sensor_tables(), from which the members above were made

  std::optional<StandIn> stand_in{};  ///< in place of its device, which is not opened; none: the device
};

/// Sets `value`, and its copy in `blend`, to sensor_value_of() with what the driver states.
void set_value(SensorConfig& sensor, const std::optional<drivers::sensor::StatedValue>& stated);

/// Its origin, or its name if it is in no file: how a message about it begins.
const std::string& place_of(const SensorConfig& sensor) noexcept;

/// The integral length of the gusts at a sensor before it is fitted to its readings, m: [wind] default_length if it
/// is set; else from the sensor's height; else that of the default wind. Pure.
double gust_length_m(const WindConfig& wind, const SensorConfig& sensor) noexcept;

/// Sets the integral length of the gusts from the sensor's height, if that is known: 8.1 * 0.7 times the height, up
/// to 60 m (IEC 61400-1), at least kMinGusts_m. If the calibration scales speeds to another height, the length
/// is scaled by the same factor, so that the time scale is unchanged.
void set_gust_length(SensorConfig& sensor) noexcept;

/// The tables below a [[sensor]] of any kind. Their values make the members of a SensorConfig that has its driver.
using SensorTable = TableOf<SensorConfig>;
std::span<const SensorTable> sensor_tables();

/// The names of those that are also read by themselves.
inline constexpr std::string_view kBlendTable = "blend";
inline constexpr std::string_view kCalibrationTable = "calibration";

/// From values of [sensor.calibration] that are in no file. Throws std::runtime_error if they contradict each other.
wind::judging::Calibration calibration_of(const ParameterValues& values);

}  // namespace yuragi::daemon::settings
