#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi {

/// A value that a sensor's entry is to have.
struct ConfigChange {
  std::string table;  ///< "calibration", or empty: the [[sensor]] itself
  std::string key;
  ParameterValue value;
};

/// The text of a configuration with some values of one sensor changed, and nothing else: comments, order, layout and
/// line ends stay. A key that is not there is added behind the others of its table, and [sensor.calibration] where it
/// is missing. `sensor` is called as parse_config() calls it: by its name, or by its driver.
///
/// The result is parsed again: it says what the old text said but for these changes. Where that cannot be done (or the
/// text is no TOML, or there is no such sensor), the failure says what to write by hand. Pure: text in, text out.
Result<std::string, Failure> edit_sensor(std::string_view toml_text, std::string_view sensor,
                                         std::span<const ConfigChange> changes);

/// A value as TOML has it: numbers in the fewest digits that mean them.
std::string toml_value(const ParameterValue& value);

}  // namespace yuragi
