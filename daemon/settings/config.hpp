#pragma once

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

namespace yuragi {

/// An installation, read from TOML and made into types once. Every value is within its range; what the file leaves out
/// has its default. The self-described tables (config_tables.hpp, shaping_parameters.hpp, sensor_blend.hpp) say what
/// may be written.
struct Config {
  std::uint64_t seed = 1;
  StreamConfig stream;
  AnimationConfig animation;
  WindConfig wind;
  ShapingConfig shaping;
  std::vector<SensorConfig> sensors;  ///< in the order of preference; at least one
  std::vector<SceneConfig> scenes;    ///< at least one

  /// The values of the tables under their names, of which these members were made: what writes the configuration out
  /// reads them, and nobody else.
  struct ByName {
    ParameterValues stream, animation, wind, shaping;
  } by_name;
};

/// What is wrong with a configuration, one line for each mistake: `file:line:column: key: what is wrong; what is
/// allowed`.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What `yuragi run` does without a file: one synthetic sensor and one grass scene.
Config default_config();

/// A sensor that no file tells of, with the defaults of the tables that every sensor has.
SensorConfig default_sensor(std::string name, const DriverDescription& driver, ParameterValues values,
                            std::string origin = {});

/// The same installation, listening at another address. The address is not checked.
Config listening_at(Config config, const std::string& address);

/// Reads a configuration. `source_name` stands in messages. Throws ConfigError with every mistake that was found.
Config parse_config(std::string_view toml_text, const std::string& source_name);

/// The text of a file. Throws ConfigError where it cannot be read.
std::string read_config_text(const std::filesystem::path& file);

/// The configuration of a file. A file that cannot be read is a ConfigError too.
Config load_config(const std::filesystem::path& file);

/// Makes the sensor, without touching its device. Throws ConfigError where its values cannot work together.
std::unique_ptr<Sensor> open_sensor(const SensorConfig& sensor);

/// The configuration as TOML with every value written out, but for what has none where it is left out: what a recording
/// keeps, and what `check-config` shows. It writes the seed and the values by name; a change of the types alone does
/// not show.
std::string to_toml(const Config& config);
std::string to_toml(const ParameterValues& values);

/// The way back: the values of a table alone, such as a recording keeps of each sensor. Fails with the first mistake.
Result<ParameterValues, Failure> parse_values(std::string_view toml_text, std::span<const Parameter> parameters);

}  // namespace yuragi
