#pragma once

#include <cstdint>
#include <optional>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::usb {

// A cup anemometer on a counter: speed from the number of pulses in a window of time.
// Source: drivers/SOURCES.md S3.3.
//
// Polled ten times a second, a cup gives 0 or 1 pulses a poll, and a speed from each poll would be noise. So the window
// varies: it is open until enough pulses have come, or for longest_window_s. A storm is measured within a poll, a
// breeze within a second.

/// The cup's line and the window. What it must satisfy: metres_per_pulse > 0, 0 < shortest_window_s <=
/// longest_window_s, all finite.
struct CupCalibration {
  double metres_per_pulse = 0.1;  ///< wind that passes between two pulses: the slope, m/s for each pulse a second
  double offset_m_s = 0.0;        ///< the wind below which the cup stands; added if any pulse came
  std::uint32_t enough_pulses = 4;
  double shortest_window_s = 0.05;  ///< however many pulses: two reads close together make no gust of a late one
  double longest_window_s = 1.0;
};

/// The state between calls; the owner keeps one for each time that the device was opened.
struct CupState {
  std::optional<std::uint32_t> last_count;
  std::uint64_t pulses = 0;  ///< in the open window
  double window_s = 0.0;     ///< how long it has been open
};

/// Takes the counter's next value, `elapsed_s` after the one before, by the times at which they were read. Where that
/// closes the window: the speed in m/s, exactly 0 if no pulse came. Nullopt while it stays open, and for the first
/// value. The counter may wrap at 2^32. kImplausible if it has gone back (the device was reset), or on by more than
/// any wind can drive it, or if time has not advanced (negative, not finite): the window starts again with this value.
/// A reset that looks like a wrap (from just below 2^32 to a small count) is not detected, but bounded in the same way.
/// Realtime-safe: yes; thread-safe: for distinct states.
std::optional<Result<double, Refusal>> advance_cup(CupState& state, const CupCalibration& cup, std::uint32_t count,
                                                   double elapsed_s) noexcept;

}  // namespace yuragi::drivers::decode::usb
