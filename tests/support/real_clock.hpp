#pragma once

#include "drivers/sensor/clock.hpp"

namespace yuragi {

/// The machine's clocks, for conversations with programs that have them too.
class RealClock final : public Clock {
 public:
  Instant now() const noexcept override { return {std::chrono::steady_clock::now(), std::chrono::system_clock::now()}; }
};

}  // namespace yuragi
