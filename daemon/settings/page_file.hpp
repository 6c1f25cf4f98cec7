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
#include "daemon/settings/parameter_edit.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::settings {

// page.toml: the sensors that were set up on the page, calibrations of others, and the values of [look] and of scenes
// that are kept there. It is read after the configuration, and is hostile until here: whoever may change something on
// the page must not gain the rights of the daemon's user by it.

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

/// The configuration as the daemon reads it: with the values and the sensors of its page_file(). If that file has a
/// mistake, or its sensors cannot be used beside those of the configuration, they are left out, and
/// Config::page_trouble has the reason. Throws ConfigError for the configuration alone.
Config load_installation(const std::filesystem::path& file);

/// The same for a configuration that was read from `file` already.
Config with_page_file(Config config, const std::filesystem::path& file);

/// The configuration with the values of [look] and of scenes in the page's text: those that edited() allows replace its
/// own, the others are in Config::passed_over. Unchanged if the text is not TOML. Pure.
Config with_page_values(const Config& config, std::string_view page_text, const std::string& source_name);

/// What a person is to know of the page's file: what of it is left out or passed over, and why. Pure.
std::vector<std::string> page_warnings(const Config& config);

/// The configuration with another text in place of the page's file, called `source_name` in messages, without its
/// values. Throws ConfigError for either.
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

/// The values that a calibration on the page may set, by their names there: those of [sensor.calibration] that a
/// calibration finds and, of a driver whose sensors measure sound, its own gain, exponent and curve as level_gain,
/// level_exponent and level_curve.
std::vector<Parameter> page_calibration_keys(const drivers::sensor::DriverDescription& driver);

/// The place of such a name in a sensor's entry, without a value; and the name of a place. Pure.
ConfigChange place_of_page_key(std::string_view name);
std::string page_key_of(const ConfigChange& place);

/// The value that a sensor has at a place. Throws std::out_of_range if its driver has no such key.
const ParameterValue& value_at(const SensorConfig& sensor, const ConfigChange& place);

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

/// The page's file with these values in place of its own of the same keys. `edited`: a configuration that has them.
/// Fails if the text is not TOML. Pure.
Result<std::string, Failure> with_values(std::string_view page_text, std::span<const ParameterEdit> values,
                                         const Config& edited);

/// The page's file without [look] and scenes; fails if the text is not TOML. Pure.
Result<std::string, Failure> without_values(std::string_view page_text);

/// The names of its values as in Config::kept, also those that are passed over; fails if the text is not TOML. Pure.
Result<std::vector<std::string>, Failure> kept_in(std::string_view page_text);

/// Returns true if both texts have the same sensors and calibrations; false if one is not TOML. Pure.
bool have_same_sensors(std::string_view page_text, std::string_view other);

}  // namespace yuragi::daemon::settings
