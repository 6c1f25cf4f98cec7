#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "engine/base/state_pass.hpp"

namespace yuragi::wind::shaping {

/// The distribution of wind speeds at a place: the time spent at each speed, with an exponential memory.
///
/// 96 bins, eight to an octave from 0.05 m/s up to 205 m/s: a percentile is right to a few per cent, at any site. Lower
/// speeds are counted in the first. Thread-safe: no. Realtime-safe: yes.
class SpeedMemory {
 public:
  static constexpr std::size_t kBins = 96;

  /// `memory_s`, above 0: the time after which 1/e of a moment is still remembered.
  explicit SpeedMemory(double memory_s) noexcept : memory_s_(memory_s) {}

  /// Changes the memory; a longer content is scaled to it.
  void change_memory(double memory_s) noexcept;

  /// Adds dt_s at this speed (finite, at least 0).
  void add(double speed_m_s, double dt_s) noexcept;

  /// The speed that was not exceeded for this share (0 to 1) of the time. 0 if nothing is known.
  double percentile(double share) const noexcept;

  /// How much is remembered, at most the memory.
  double known_s() const noexcept;

  /// The time at each speed, s, for a file; and back: a total beyond this memory is scaled to it. An invalid table (not
  /// kBins numbers from 0 to 1e12) is refused with false and changes nothing.
  std::span<const double, kBins> times_s() const noexcept { return times_s_; }
  bool restore(std::span<const double> times_s) noexcept;

  void list_state(StatePass& pass) { pass.within(std::span<double>(times_s_), 0.0, StatePass::kLargestTotal); }

 private:
  double memory_s_;
  std::array<double, kBins> times_s_{};
};

}  // namespace yuragi::wind::shaping
