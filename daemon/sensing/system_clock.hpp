#pragma once

#include "drivers/sensor/clock.hpp"

namespace yuragi::daemon::sensing {

/// The machine's own clocks. Thread-safe and realtime-safe.
class SystemClock final : public drivers::sensor::Clock {
 public:
  Instant now() const noexcept override {
    return {.mono = std::chrono::time_point_cast<Nanoseconds>(std::chrono::steady_clock::now()),
            .utc = std::chrono::time_point_cast<Nanoseconds>(std::chrono::system_clock::now())};
  }
};

}  // namespace yuragi::daemon::sensing
