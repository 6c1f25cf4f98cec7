#pragma once

#include <optional>

#include "daemon/sensing/system_clock.hpp"

namespace yuragi::daemon::sensing {

/// The machine's clocks, or while it is held the moment that hold() was given: for a replay that runs ahead, in steps.
/// Thread-safe and realtime-safe while nobody calls hold() or let_go().
class HeldClock final : public drivers::sensor::Clock {
 public:
  Instant now() const noexcept override { return held_ ? *held_ : system_.now(); }

  void hold(const Instant& moment) noexcept { held_ = moment; }
  void let_go() noexcept { held_.reset(); }

  /// The time of the machine's clocks meanwhile.
  Instant of_machine() const noexcept { return system_.now(); }

 private:
  SystemClock system_;
  std::optional<Instant> held_;
};

}  // namespace yuragi::daemon::sensing
