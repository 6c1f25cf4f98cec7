#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/time.hpp"

namespace yuragi::platform {

/// Two machines whose clocks differ by more are visibly out of step on one wall.
inline constexpr double kMaxClockOffset_s = 0.005;

/// How far this machine's clock is off, as reported by what sets it.
struct ClockOffset {
  /// This clock less UTC; the kernel's estimate is without a sign. Nullopt: unknown.
  std::optional<double> offset_s = std::nullopt;
  std::string source = {};  ///< who reports it: "chrony"; if it is unknown, why: "no time service replies"

  bool is_large() const noexcept {
    return offset_s && (*offset_s > kMaxClockOffset_s || *offset_s < -kMaxClockOffset_s);
  }
  friend bool operator==(const ClockOffset&, const ClockOffset&) = default;
};

/// "clock 0.3 ms ahead of UTC (chrony)", "clock's offset unknown (no time service replies)".
std::string text_of(const ClockOffset& offset);

/// The programs that are asked, found by PATH.
struct ClockPrograms {
  std::vector<std::string> chrony = {"chronyc", "-n", "-c", "tracking"};
  std::vector<std::string> timesyncd = {"busctl",
                                        "--system",
                                        "--auto-start=no",
                                        "--timeout=1",
                                        "get-property",
                                        "org.freedesktop.timesync1",
                                        "/org/freedesktop/timesync1",
                                        "org.freedesktop.timesync1.Manager",
                                        "NTPMessage"};
};

/// Asks chrony, then systemd-timesyncd, then the kernel. Waits for each program for 2 s at most, and not while the
/// descriptor `interruption` is readable (-1: none). `now`: by this machine's clock. Thread-safe.
ClockOffset read_clock_offset(UtcTime now, const ClockPrograms& programs = {}, int interruption = -1);

/// The offset in a line of `chronyc -c tracking`. Nullopt if the line is invalid, or if chrony's last measurement is
/// older than two hours.
std::optional<double> chrony_offset_s(std::string_view line, UtcTime now);

/// The offset at its last message from a server, in the property NTPMessage of systemd-timesyncd as busctl prints it.
/// Nullopt if the text is invalid, or if the message is older than two hours.
std::optional<double> timesyncd_offset_s(std::string_view text, UtcTime now);

}  // namespace yuragi::platform
