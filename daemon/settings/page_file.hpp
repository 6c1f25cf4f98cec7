#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/settings/config.hpp"
#include "daemon/settings/config_edit.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::settings {

// page.toml: the sensors that were set up on the page, and calibrations of others. It is read after the configuration,
// and is hostile until here: whoever may change something on the page must not gain the rights of the daemon's user by
// it.

/// The largest file that is read.
inline constexpr std::size_t kMaxPage_bytes = std::size_t{64} << 10;

/// Where it is: state_file(), or, for the configuration of the service, in the folder that its unit has. Empty:
/// nowhere.
std::filesystem::path page_file(const std::filesystem::path& config_file);

/// Why the page may not set a key of a driver; nullopt if it may. Numbers, true, false and one of several words are
/// harmless. A text is refused unless it is listed here as one that names no file and no program: so a new key is
/// refused until somebody decides. Pure.
std::optional<std::string> page_refusal(const drivers::sensor::DriverDescription& driver, const Parameter& key);

/// The same for a value of such a key: a serial port must be a device, a profile a name. Pure.
std::optional<std::string> page_refusal(const drivers::sensor::DriverDescription& driver, const Parameter& key,
                                        const ParameterValue& value);

/// The configuration as the daemon reads it: with the sensors of its page_file(). If that file has a mistake, or its
/// sensors cannot be used beside those of the configuration, it is left out, and Config::page_trouble has the reason.
/// Throws ConfigError for the configuration alone.
Config load_installation(const std::filesystem::path& file);

/// The same for a configuration that was read from `file` already.
Config with_page_file(Config config, const std::filesystem::path& file);

/// The same with another text in place of the page's file, called `source_name` in messages. Throws ConfigError for
/// either.
Config with_page_checked(const Config& config, std::string_view page_text, const std::string& source_name);

/// A sensor as the page sets it up.
struct PageSensor {
  std::string name = {};
  std::string driver = {};
  /// Keys of the driver with their values as they are typed after "KEY=".
  std::vector<std::pair<std::string, std::string>> values = {};
};

/// The page's file with one more sensor, which with_page_checked() has yet to check. Pure.
std::string with_sensor(std::string_view page_text, const PageSensor& sensor);

/// The page's file without a sensor; fails if there is none of this name, or the text is not TOML. Pure.
Result<std::string, Failure> without_sensor(std::string_view page_text, std::string_view name);

/// The keys of [sensor.calibration] that the page may set: what a calibration finds.
std::span<const Parameter> page_calibration_keys();

/// The page's file with values of page_calibration_keys() for a sensor: in the sensor's own entry if the page has set
/// it up, otherwise as a [[calibration]] of the sensor of `config`, which is the configuration without the page. There
/// they stand with what they replace, and count only until the configuration has other values: a later calibration of
/// it is never overridden. Fails if there is no such sensor, or the text is not TOML. Pure.
Result<std::string, Failure> with_calibration(std::string_view page_text, const Config& config, std::string_view sensor,
                                              std::span<const ConfigChange> changes);

/// The page's file without its [[calibration]] of a sensor; fails if there is none, or the text is not TOML. Pure.
Result<std::string, Failure> without_calibration(std::string_view page_text, std::string_view sensor);

/// The sensors that have a [[calibration]], in order; fails if the text is not TOML. Pure.
Result<std::vector<std::string>, Failure> calibrations_in(std::string_view page_text);

/// What a [[calibration]] replaces, as it is written in it: those values of a sensor on which it depends. Pure.
std::vector<std::pair<std::string_view, ParameterValue>> replaced_by_page(const SensorConfig& sensor);

/// The names of its sensors, in order; fails if the text is not TOML. Pure.
Result<std::vector<std::string>, Failure> sensors_in(std::string_view page_text);

}  // namespace yuragi::daemon::settings
