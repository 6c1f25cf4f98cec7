#pragma once

#include <string_view>

namespace yuragi::daemon::settings {

/// A recorded sensor speaks on change only: for how long, s, its silence says that nothing has changed
/// (DriverDescription::unchanged_for_s); 0: it does not, or its driver or options are not known here. `driver` and
/// `options`: as the recording has them. Thread-safe: yes.
double recorded_unchanged_for_s(std::string_view driver, std::string_view options);

}  // namespace yuragi::daemon::settings
