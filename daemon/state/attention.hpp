#pragma once

#include <string>
#include <vector>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::state {

/// Below this a disk counts as nearly full: the default of [recording] min_free.
inline constexpr double kLittleFreeSpace_bytes = 200e6;
/// A lateness that 1 % of all steps exceed. Sixty ticks a second: above it ticks are skipped.
inline constexpr double kLateTicks_s = 1.0 / 60.0;
/// The same of the I/O thread: a reading is used so much later.
inline constexpr double kLateIo_s = 0.1;

/// What of a running daemon needs a person's attention, a sentence for each thing: a sensor whose readings are not
/// used, a recorder that cannot write, that has dropped readings or whose disk is nearly full, and steps that are late.
/// Empty: all is well. Pure.
std::vector<std::string> needs_attention(const wire::Sensors& sensors);

}  // namespace yuragi::daemon::state
