#pragma once

#include <cstdint>
#include <random>

#include "engine/base/time.hpp"

namespace yuragi::platform {

/// How long to wait before the next attempt: doubles from `first` up to `cap`, and stays there; each wait is shortened
/// by up to a quarter at random, so that sensors that failed together do not retry together.
///
/// The same seed gives the same waits. Thread-safe: no. Realtime-safe: yes.
class Backoff {
 public:
  Backoff(Nanoseconds first, Nanoseconds cap, std::uint32_t seed)
      : first_(first), cap_(cap), next_(first), bits_(seed) {}

  /// The wait after one more failure; above 0, at most `cap`.
  Nanoseconds next() {
    const Nanoseconds full = next_;
    next_ = full < cap_ / 2 ? 2 * full : cap_;
    return full - full / 4 * static_cast<std::int64_t>(bits_() % kSteps) / kSteps;
  }

  /// After a success.
  void reset() { next_ = first_; }

 private:
  static constexpr std::int64_t kSteps = 1024;

  Nanoseconds first_;
  Nanoseconds cap_;
  Nanoseconds next_;
  std::minstd_rand bits_;
};

}  // namespace yuragi::platform
