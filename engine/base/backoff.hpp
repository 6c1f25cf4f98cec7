#pragma once

#include <cstdint>

#include "engine/base/time.hpp"

namespace yuragi {

/// How long to wait before the next attempt: doubles from `first` up to `cap`, and stays there; each wait is shortened
/// by up to a quarter at random, so that those that failed together do not come back in step.
///
/// The same seed gives the same waits. Thread-safe: no. Realtime-safe: yes.
class Backoff {
 public:
  Backoff(Nanoseconds first, Nanoseconds cap, std::uint32_t seed)
      : first_(first), cap_(cap), next_(first), state_(1 + seed % (kModulus - 1)) {}

  /// The wait after one more failure; more than nothing, at most `cap`.
  Nanoseconds next() {
    const Nanoseconds full = next_;
    next_ = full < cap_ / 2 ? 2 * full : cap_;
    state_ = state_ * kMultiplier % kModulus;
    return full - full / 4 * static_cast<std::int64_t>(state_ % kSteps) / static_cast<std::int64_t>(kSteps);
  }

  /// After a success.
  void reset() { next_ = first_; }

 private:
  static constexpr std::uint64_t kSteps = 1024;
  /// Park and Miller's generator (S. K. Park, K. W. Miller, P. K. Stockmeyer 1993, "Remarks on choosing and
  /// implementing random number generators"): the state is never 0.
  static constexpr std::uint64_t kMultiplier = 48271;
  static constexpr std::uint64_t kModulus = 2147483647;

  Nanoseconds first_;
  Nanoseconds cap_;
  Nanoseconds next_;
  std::uint64_t state_;
};

}  // namespace yuragi
