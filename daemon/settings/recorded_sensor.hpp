#pragma once

#include <optional>
#include <string_view>

#include "drivers/sensor/stated_value.hpp"

namespace yuragi::daemon::settings {

/// What the driver of a recorded sensor states about it. Default: it states nothing, or driver or options are
/// unknown here.
struct RecordedSource {
  /// For a sensor that sends only changes: the duration, s, for which silence means no change
  /// (DriverDescription::unchanged_for_s); 0: it sends at intervals.
  double unchanged_for_s = 0.0;
  std::optional<drivers::sensor::StatedValue> value{};  ///< DriverDescription::stated_value
};

/// `options`: as the recording has them. Thread-safe: yes.
RecordedSource recorded_source(std::string_view driver, std::string_view options);

}  // namespace yuragi::daemon::settings
