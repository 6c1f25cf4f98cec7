#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/platform/clock_offset.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::state {

/// Below this a disk counts as nearly full: the default of [recording] min_free.
inline constexpr double kLittleFreeSpace_bytes = 200e6;
/// The share of ticks of the last 10 minutes from which skipped ones need attention.
inline constexpr double kMaxSkippedShare = 0.01;
/// With fewer ticks nothing is judged: 10 s at 60 Hz. The first ticks of a daemon may be late.
inline constexpr double kMinJudgedTicks = 600.0;
/// A lateness of the I/O thread that 1 % of its steps exceed: a reading is used so much later.
inline constexpr double kLateIo_s = 0.1;

/// What of a running daemon needs a person's attention, a sentence for each thing: a sensor whose readings are not
/// used or lack what they should have, a recorder that cannot write, that has dropped readings or whose disk is nearly
/// full, and steps that are skipped or late. Empty: all is well. Pure.
std::vector<std::string> needs_attention(const wire::Sensors& sensors);

/// For Sensors::troubles of a wall whose screens are in step by the machines' clocks: what is wrong with this one's.
/// Empty if it is right, or unknown. Pure.
std::string clock_trouble(const platform::ClockOffset& offset);
/// The same for the clock of the machine of a viewer, by its address.
std::string clock_trouble_of_viewer(std::string_view viewer, double offset_s);

}  // namespace yuragi::daemon::state
