#pragma once

#include <chrono>

namespace yuragi {

// The engine reads no clock: time is a parameter, of these types.

using Nanoseconds = std::chrono::nanoseconds;
/// A monotonic moment with an arbitrary zero. All intervals and ages are measured on it.
using MonoTime = std::chrono::time_point<std::chrono::steady_clock, Nanoseconds>;
/// A moment for people and files. It may jump either way when a machine's clock is set.
using UtcTime = std::chrono::sys_time<Nanoseconds>;

/// One moment on both time lines.
struct Instant {
  MonoTime mono{};
  UtcTime utc{};
};

inline double seconds(Nanoseconds duration) {
  return std::chrono::duration<double>(duration).count();
}

inline Nanoseconds from_seconds(double duration_s) {
  return std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(duration_s));
}

}  // namespace yuragi
