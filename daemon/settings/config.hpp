#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/animation_config.hpp"
#include "daemon/settings/config_tables.hpp"
#include "daemon/settings/scene_config.hpp"
#include "daemon/settings/sensor_config.hpp"
#include "daemon/settings/shaping_config.hpp"
#include "daemon/settings/stream_config.hpp"
#include "daemon/settings/wind_config.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings {

/// No client takes more in one message; the recording that plays while all sensors are silent counts as another sensor.
inline constexpr std::size_t kMostSensors = 255;
inline constexpr std::size_t kMostScenes = 64;

/// The configuration of an installation, parsed from TOML. Every value is within its range; what the file leaves out
/// has its default. The keys are described in config_tables.hpp, shaping_parameters.hpp and sensor_blend.hpp.
struct Config {
  std::uint64_t seed = 1;
  StreamConfig stream;
  AnimationConfig animation;
  WindConfig wind;
  ShapingConfig shaping;
  std::vector<SensorConfig> sensors;  ///< in the order of preference; at least one
  std::vector<SceneConfig> scenes;    ///< at least one

  /// The values of the tables by key, from which the members above were made. For to_toml() only.
  struct ByName {
    ParameterValues stream, animation, wind, shaping;
  } by_name;
};

/// The errors in a configuration, one line for each: `file:line:column: key: what is wrong; what is
/// allowed`.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What `yuragi run` does without a file: one synthetic sensor and one grass scene.
Config default_config();

/// A sensor that is in no file, with the defaults of the tables that every sensor has.
SensorConfig default_sensor(std::string name, const drivers::sensor::DriverDescription& driver, ParameterValues values,
                            std::string origin = {});

/// The same configuration with another listening address, which is not checked.
Config listening_at(Config config, const std::string& address);

/// Reads a configuration. `source_name` is the file name in error messages. Throws ConfigError with every error found.
Config parse_config(std::string_view toml_text, const std::string& source_name);

/// The text of a file. Throws ConfigError where it cannot be read.
std::string read_config_text(const std::filesystem::path& file);

/// Reads a configuration file. Throws ConfigError, also where the file cannot be read.
Config load_config(const std::filesystem::path& file);

/// Makes the sensor, without touching its device. Throws ConfigError where its values contradict each other.
std::unique_ptr<drivers::sensor::Sensor> open_sensor(const SensorConfig& sensor);

/// The configuration as TOML with every value written out, except keys without a default that are not set. Stored in
/// recordings and printed by `check-config`. Written from `seed`, `by_name` and the tables of sensors and scenes: a
/// change of other members has no effect on it.
std::string to_toml(const Config& config);
std::string to_toml(const ParameterValues& values);

/// The reverse for one table, such as a recording stores for each sensor. Fails with the first error.
Result<ParameterValues, Failure> parse_values(std::string_view toml_text, std::span<const Parameter> parameters);

}  // namespace yuragi::daemon::settings
