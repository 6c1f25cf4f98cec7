#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/alert_config.hpp"
#include "daemon/settings/config_error.hpp"
#include "daemon/settings/feeds/feeds.hpp"
#include "daemon/settings/feeds/lists.hpp"
#include "daemon/settings/http_config.hpp"
#include "daemon/settings/local_clock.hpp"
#include "daemon/settings/log_config.hpp"
#include "daemon/settings/recording_config.hpp"
#include "daemon/settings/scene_config.hpp"
#include "daemon/settings/sensor_config.hpp"
#include "daemon/settings/shaping_config.hpp"
#include "daemon/settings/stream_config.hpp"
#include "daemon/settings/table_of.hpp"
#include "daemon/settings/wind_config.hpp"
#include "daemon/values/moment.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/base/parameter.hpp"
#include "engine/look/camera.hpp"
#include "engine/look/look.hpp"
#include "engine/output/output.hpp"

namespace yuragi::daemon::settings {

/// No client takes more in one message; the recording that plays while all sensors are silent counts as another sensor.
inline constexpr std::size_t kMaxSensors = 255;
inline constexpr std::size_t kMaxScenes = 64;

/// [animation]: tick rate and threads.
struct AnimationConfig {
  double rate_hz = 0.0;     ///< ticks per second, of the wind and of the scenes
  std::size_t threads = 1;  ///< that share the work of a tick
  bool resumes = true;      ///< goes on with the motion of the run before
};

/// A [[camera]].
struct CameraConfig {
  std::string name;
  ParameterValues values{};  ///< of look::camera_parameters()
  look::Camera camera{};     ///< made of these
};

/// A calibration that the page has made of a sensor of the configuration.
struct PageCalibration {
  std::string sensor;
  std::string values;   ///< for a person: "gain = 1.04, offset = -0.31"
  std::string why_not;  ///< why it does not count; empty: it does
};

/// The configuration of an installation, parsed from TOML. Every value is within its range; what the file leaves out
/// has its default. The keys are those of config_tables(), sensor_tables() and of the lists.
struct Config {
  std::uint64_t seed = 1;
  StreamConfig stream;
  HttpConfig http;
  RecordingConfig recording;
  AnimationConfig animation;
  WindConfig wind;
  ShapingConfig shaping;
  look::Look look;
  LogConfig log;
  std::vector<SensorConfig> sensors;  ///< in the order of preference; at least one
  std::vector<SceneConfig> scenes;    ///< at least one
  std::vector<CameraConfig> cameras;
  std::vector<AlertConfig> alerts;
  std::vector<output::Table> outputs;  ///< for the viewers, which read the file themselves; only checked here
  feeds::Lists lists;                  ///< the entries of feeds::list_tables(), as they are written
  feeds::Config feeds;                 ///< made of them
  LocalClock clock;  ///< by which the cameras change: of the zone of [shaping]; UTC if no camera has a time

  // Of page.toml (load_installation()):
  std::string page_file = {};     ///< the file, whose sensors are the last ones; empty: there is none
  std::string page_trouble = {};  ///< why its sensors are left out, each line as in a ConfigError; empty: they are not
  std::vector<PageCalibration> page_calibrations = {};
  std::vector<std::string> kept = {};         ///< the values that it overrides: "[look] haze", "scene elm: height"
  std::vector<std::string> passed_over = {};  ///< the values in it that cannot be used, each as in a ConfigError

  /// The values of config_tables(), from which the members above were made. Only for writing, comparing and changing
  /// them.
  TablesByName by_name;
};

/// The tables that occur once in the file, and the keys at its top, whose name is empty: for each its keys, and their
/// effect on a Config. All functions that read, write, describe, compare or change a configuration use them.
using ConfigTable = TableOf<Config>;
std::span<const ConfigTable> config_tables();

/// One of them. Throws std::logic_error if there is none.
const ConfigTable& config_table(std::string_view name);

/// The names of the lists of tables: sensor, scene, camera, alert, output, and those of feeds::list_tables().
std::span<const std::string_view> config_lists();

/// The names that a feed may refer to.
values::Names names_of(const Config& config);

/// What `yuragi run` does without a file: one synthetic sensor, a grass scene and the ground around it.
Config default_config();

/// A sensor that is in no file, with the defaults of the tables that every sensor has.
SensorConfig default_sensor(std::string name, const drivers::sensor::DriverDescription& driver, ParameterValues values,
                            std::string origin = {});

/// The same configuration with another listening address, which is not checked.
Config listening_at(Config config, const std::string& address);

/// Reads a configuration, but not the pictures that it names. `source_name` is the file name in error messages. Throws
/// ConfigError with every error found.
Config parse_config(std::string_view toml_text, const std::string& source_name);

/// The configuration with the page's file (page_file.hpp): its sensors, with names of their own and keys that the page
/// may set, and its calibrations of sensors of the configuration. Besides these that file has only [look] and
/// [[scene]], which are not read here. The synthetic sensor of a file without any is replaced. Throws ConfigError with
/// every error found in this text.
Config with_page(const Config& config, std::string_view toml_text, const std::string& source_name);

/// The largest configuration that is read, in bytes: many times what any installation needs.
inline constexpr std::size_t kMaxConfig_bytes = 1 << 20;

/// The text of a file. Throws ConfigError if it cannot be read, is no regular file (a folder, a pipe), or is larger
/// than kMaxConfig_bytes. Waits for nothing but the disk.
std::string read_config_text(const std::filesystem::path& file);

/// Reads a configuration file, and the pictures that it names, from its folder on. Throws ConfigError, also if one
/// of them cannot be read.
Config load_config(const std::filesystem::path& file);

/// Makes the sensor, without touching its device. Throws ConfigError if its values contradict each other.
std::unique_ptr<drivers::sensor::Sensor> open_sensor(const SensorConfig& sensor);

/// Makes all sensors, so that it also throws if two of them cannot be used together (different settings for one
/// serial line, the same device: refuse_same_device()).
std::vector<std::unique_ptr<drivers::sensor::Sensor>> open_sensors(std::span<const SensorConfig> sensors);

/// Makes a sensor and forgets it, without touching its device. Throws ConfigError if its values contradict each
/// other; not if they contradict those of a sensor that runs on the same line.
void check_sensor(const SensorConfig& sensor);

/// The configuration as TOML with every value written out, except keys without a default that are not set. Stored in
/// recordings and printed by `check-config`. In place of a secret stands Secret::kWithheld. Written from `seed`,
/// `by_name` and the tables of sensors and scenes: a change of other members has no effect on it.
std::string to_toml(const Config& config);
std::string to_toml(const ParameterValues& values);

/// The same for a recording: the opening hours name their time zone, also if that is the machine's own.
std::string to_recorded_toml(Config config);

/// The reverse for one table, such as a recording stores for each sensor. Fails with the first error. A secret in it is
/// withheld (Secret::is_withheld).
Result<ParameterValues, Failure> parse_values(std::string_view toml_text, std::span<const Parameter> parameters);

}  // namespace yuragi::daemon::settings
