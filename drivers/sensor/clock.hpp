#pragma once

#include "engine/base/time.hpp"

namespace yuragi {

/// Where a driver learns the time. The daemon gives the system's clocks, a test one that it advances by hand.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Instant now() const noexcept = 0;
};

}  // namespace yuragi
