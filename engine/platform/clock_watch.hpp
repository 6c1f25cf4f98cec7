#pragma once

#include <functional>
#include <mutex>
#include <thread>

#include "engine/platform/clock_offset.hpp"
#include "engine/platform/descriptor.hpp"

namespace yuragi::platform {

/// Reads the clock's offset every 30 s on a thread of its own, for programs that must not wait. Thread-safe.
class ClockWatch {
 public:
  /// `now` returns the time by this machine's clock; it is called on the thread. Throws std::system_error if the system
  /// gives no thread or descriptor.
  explicit ClockWatch(std::function<UtcTime()> now, ClockPrograms programs = {});
  /// Interrupts a program that is waited for.
  ~ClockWatch();
  ClockWatch(const ClockWatch&) = delete;
  ClockWatch& operator=(const ClockWatch&) = delete;

  /// The last one that was read.
  ClockOffset latest() const;

 private:
  void run();

  const std::function<UtcTime()> now_;
  const ClockPrograms programs_;
  const Descriptor interruption_;
  mutable std::mutex mutex_;
  ClockOffset latest_{.offset_s = std::nullopt, .source = "not read yet"};
  std::thread thread_;  // the last: it uses the others
};

}  // namespace yuragi::platform
