#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace yuragi::wind::shaping {

/// How often which wind blows at a place: the time spent at each speed, forgotten exponentially.
///
/// 96 bins, eight to an octave from 0.05 m/s up to 205 m/s: a percentile is right to a few per cent, whatever the
/// site. What is slower than the first is counted there. Thread-safe: no. Realtime-safe: yes.
class SpeedMemory {
 public:
  static constexpr std::size_t kBins = 96;

  /// `memory_s`, above 0: after so long, 1/e of a moment is still remembered.
  explicit SpeedMemory(double memory_s) noexcept : memory_s_(memory_s) {}

  /// Remembers for another time from now on; more than that is scaled to it.
  void change_memory(double memory_s) noexcept;

  /// It blew at this speed (finite, at least 0) for dt_s.
  void add(double speed_m_s, double dt_s) noexcept;

  /// The speed below which it blew for this share (0 to 1) of the time. 0 if nothing is known.
  double percentile(double share) const noexcept;

  /// How much is remembered, at most the memory.
  double known_s() const noexcept;

  /// The time at each speed, s, for a file; and back: more than this memory holds is scaled to it. What is no such
  /// table (not kBins numbers from 0 to 1e12) is refused with false and changes nothing.
  std::span<const double, kBins> times_s() const noexcept { return times_s_; }
  bool restore(std::span<const double> times_s) noexcept;

 private:
  double memory_s_;
  std::array<double, kBins> times_s_{};
};

}  // namespace yuragi::wind::shaping
