#pragma once

#include <optional>
#include <string_view>

#include "drivers/sensor/stated_value.hpp"

namespace yuragi::daemon::settings {

/// A recorded sensor speaks on change only: for how long, s, its silence says that nothing has changed
/// (DriverDescription::unchanged_for_s); 0: it does not, or its driver or options are not known here. `driver` and
/// `options`: as the recording has them. Thread-safe: yes.
double recorded_unchanged_for_s(std::string_view driver, std::string_view options);

/// Returns what the driver of a recorded sensor states of its speed (DriverDescription::stated_value); nullopt if it
/// states nothing, or if driver or options are unknown here. Thread-safe: yes.
std::optional<drivers::sensor::StatedValue> recorded_value(std::string_view driver, std::string_view options);

}  // namespace yuragi::daemon::settings
