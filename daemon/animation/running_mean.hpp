#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "engine/base/time.hpp"

namespace yuragi::daemon::animation {

/// The mean of a duration that comes once a tick: over all of them at first, later with a memory of kMemoryTicks.
///
/// Thread-safe: one writer, any number of readers. Realtime-safe: yes.
class RunningMean {
 public:
  static constexpr std::uint32_t kMemoryTicks = 300;  ///< 5 s at 60 Hz

  void add(Nanoseconds duration) noexcept {
    count_ = std::min(count_ + 1, kMemoryTicks);
    const double mean_s = mean_s_.load(std::memory_order_relaxed);
    mean_s_.store(mean_s + (seconds(duration) - mean_s) / count_, std::memory_order_relaxed);
  }

  /// Forgets everything: the mean is 0.
  void clear() noexcept {
    count_ = 0;
    mean_s_.store(0.0, std::memory_order_relaxed);
  }

  double mean_s() const noexcept { return mean_s_.load(std::memory_order_relaxed); }

 private:
  std::uint32_t count_ = 0;  // of the writer
  std::atomic<double> mean_s_{0.0};
};

}  // namespace yuragi::daemon::animation
