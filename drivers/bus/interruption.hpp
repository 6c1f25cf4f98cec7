#pragma once

#include <cstdint>

#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// The result of waiting for a descriptor.
enum class WaitEnd : std::uint8_t {
  kReady,        ///< it can be read (or written), or has an error
  kTimeout,      ///< not within the time
  kInterrupted,  ///< set() was called
};

/// What to wait for.
enum class WaitFor : std::uint8_t { kReadable, kWritable };

/// Lets another thread end every wait of a port, now and from then on.
///
/// Thread-safe: yes. Throws std::system_error if the process has no descriptors left.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  void set() noexcept;
  bool is_set() const noexcept;
  /// Later waits are not ended any more, until it is set again.
  void clear() noexcept;

  /// Waits for `descriptor`, or, if that is -1, for the interruption alone.
  WaitEnd wait(int descriptor, WaitFor what, Nanoseconds timeout) const noexcept;

 private:
  int event_;
};

}  // namespace yuragi::drivers::bus
