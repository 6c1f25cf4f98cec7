#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <numeric>

#include "engine/base/time.hpp"

namespace yuragi::daemon::animation {

/// A histogram of durations with eight classes to the octave, from 1 us to over an hour: percentiles in constant
/// memory, and the longest. A percentile is the upper end of its class, at most an eighth too large.
///
/// Thread-safe: one writer, any number of readers. Realtime-safe: yes.
class DurationHistogram {
  static constexpr std::size_t kStepsPerOctave = 8;
  static constexpr std::size_t kOctaves = 32;

 public:
  static constexpr std::size_t kClasses = kOctaves * kStepsPerOctave;
  /// How many durations are in each class.
  using Counts = std::array<std::uint64_t, kClasses>;

  void add(Nanoseconds duration, std::uint64_t times = 1) noexcept {
    counts_[class_of(duration)].fetch_add(times, std::memory_order_relaxed);
    if (duration > longest_.load(std::memory_order_relaxed)) longest_.store(duration, std::memory_order_relaxed);
  }

  /// The longest of all, s: exact; 0 if nothing was counted.
  double max_s() const noexcept { return seconds(longest_.load(std::memory_order_relaxed)); }

  /// The duration that `share` (0 to 1) of all counted ones do not exceed, s; 0 if nothing was counted.
  double percentile_s(double share) const noexcept { return percentile_s(counts(), share); }

  Counts counts() const noexcept {
    Counts counts{};
    for (std::size_t index = 0; index < kClasses; ++index)
      counts[index] = counts_[index].load(std::memory_order_relaxed);
    return counts;
  }

  /// percentile_s() of such counts.
  static double percentile_s(const Counts& counts, double share) noexcept {
    const auto total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    const double wanted = share * static_cast<double>(total);
    std::uint64_t seen = 0;
    for (std::size_t index = 0; index < kClasses; ++index) {
      seen += counts[index];
      if (seen > 0 && static_cast<double>(seen) >= wanted) return upper_bound_s(index);
    }
    return 0.0;
  }

 private:
  /// Classes are linear within an octave: cheap, and no logarithm is needed.
  static std::size_t class_of(Nanoseconds duration) noexcept {
    const auto us = static_cast<std::uint64_t>(duration.count() > 0 ? duration.count() / 1000 : 0);
    if (us < kStepsPerOctave) return us;
    const auto octave = static_cast<std::size_t>(std::bit_width(us)) - 1;  // at least 3
    const std::size_t step = (us >> (octave - 3)) & (kStepsPerOctave - 1);
    const std::size_t index = (octave - 2) * kStepsPerOctave + step;
    return index < kClasses ? index : kClasses - 1;
  }

  static double upper_bound_s(std::size_t index) noexcept {
    if (index < kStepsPerOctave) return static_cast<double>(index + 1) * 1e-6;
    const std::size_t octave = index / kStepsPerOctave + 2;
    const std::size_t step = index % kStepsPerOctave;
    return static_cast<double>((kStepsPerOctave + step + 1) << (octave - 3)) * 1e-6;
  }

  std::array<std::atomic<std::uint64_t>, kClasses> counts_{};
  std::atomic<Nanoseconds> longest_{Nanoseconds::zero()};
};

}  // namespace yuragi::daemon::animation
