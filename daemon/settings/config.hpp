#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/config_tables.hpp"
#include "daemon/settings/sensor_blend.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/base/parameter.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/wind/judging/calibration.hpp"
#include "engine/wind/judging/reading_judge.hpp"

namespace yuragi {

/// [sensor.calibration] and [sensor.judge] where they are not written.
ParameterValues no_calibration();
ParameterValues default_judge();

/// A sensor or a scene of an installation: which kind, how it is called, and its own parameters.
struct SensorConfig {
  std::string name;
  const DriverDescription* driver = nullptr;
  ParameterValues values;
  ParameterValues calibration;                     ///< calibration_parameters()
  std::string origin;                              ///< `file:line:column` of its entry; empty for the built-in default
  ParameterValues judge = default_judge();         ///< judge_parameters()
  ParameterValues blend = default_sensor_blend();  ///< sensor_blend_parameters()
};

struct SceneConfig {
  std::string name;
  const SceneDescription* kind = nullptr;
  ParameterValues values;  ///< its kind's own, and common_scene_parameters()
};

/// An installation, read from TOML. Every value is there and within its range; what the file leaves out has its
/// default.
struct Config {
  std::uint64_t seed = 1;
  ParameterValues stream;             ///< stream_parameters()
  ParameterValues animation;          ///< animation_parameters()
  ParameterValues wind;               ///< wind_parameters()
  ParameterValues shaping;            ///< shaping_parameters()
  std::string fallback_origin;        ///< `file:line:column` of wind.fallback_recording; empty where it is not set
  std::vector<SensorConfig> sensors;  ///< in the order of preference; at least one
  std::vector<SceneConfig> scenes;    ///< at least one
};

/// What a sensor's calibration says. Throws ConfigError for a curve that is none.
Calibration calibration_of(const SensorConfig& sensor);

/// How strictly a sensor's readings are judged; nothing where they are not.
std::optional<JudgeSettings> judge_settings_of(const SensorConfig& sensor);

/// What is wrong with a configuration, one line for each mistake: `file:line:column: key: what is wrong; what is
/// allowed`.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What `yuragi run` does without a file: one synthetic sensor and one grass scene.
Config default_config();

/// Reads a configuration. `source_name` stands in messages. Throws ConfigError with every mistake that was found.
Config parse_config(std::string_view toml_text, const std::string& source_name);

/// The text of a file. Throws ConfigError where it cannot be read.
std::string read_config_text(const std::filesystem::path& file);

/// The configuration of a file. A file that cannot be read is a ConfigError too.
Config load_config(const std::filesystem::path& file);

/// Makes the sensor, without touching its device. Throws ConfigError where its values cannot work together.
std::unique_ptr<Sensor> open_sensor(const SensorConfig& sensor);

/// The configuration as TOML with every value written out, but for what has none where it is left out: what a recording
/// keeps, and what `check-config` shows.
std::string to_toml(const Config& config);
std::string to_toml(const ParameterValues& values);

/// The way back: the values of a table alone, such as a recording keeps of each sensor. Fails with the first mistake.
Result<ParameterValues, Failure> parse_values(std::string_view toml_text, std::span<const Parameter> parameters);

}  // namespace yuragi
