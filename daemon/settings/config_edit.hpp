#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::settings {

/// A value to set in a sensor's entry.
struct ConfigChange {
  std::string table;  ///< "calibration", or empty: the [[sensor]] itself
  std::string key;
  ParameterValue value;
};

/// The text of a configuration with some values of one sensor changed, and nothing else: comments, order, layout and
/// line ends stay. A missing key is added after the others of its table, a missing [sensor.calibration] is added.
/// `sensor` is the name as parse_config() gives it: the configured name, or else the driver's.
///
/// The result is parsed again to verify that only these values differ. If others do (or the text is not TOML,
/// or there is no such sensor, or a value is a secret), the failure shows what to edit by hand. Pure.
Result<std::string, Failure> edit_sensor(std::string_view toml_text, std::string_view sensor,
                                         std::span<const ConfigChange> changes);

/// A value as TOML, as far as it may be printed; numbers with the fewest digits that read back as the same number.
std::string toml_value(const ParameterValue& value);

}  // namespace yuragi::daemon::settings
