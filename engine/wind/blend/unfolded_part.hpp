#pragma once

#include <array>
#include <cstddef>

#include "engine/base/state_pass.hpp"

namespace yuragi::wind::blend {

/// The share of the wind's own power in a source's samples at a frequency (von_karman_unfolded_part()), computed with
/// each fit, and read from a table in between. For means it is 1 everywhere. Thread-safe: no. Realtime-safe: yes.
class UnfoldedPart {
 public:
  UnfoldedPart() { parts_.fill(1.0); }

  /// Sets it for instantaneous samples every interval_s of turbulence of this time scale (both above 0).
  void set(double interval_s, double time_scale_s) noexcept;

  /// 0.001 to 1.
  double at(double frequency_hz) const noexcept;

  void list_state(StatePass& pass) {
    pass.within(interval_s_, 1e-9, StatePass::kLargest);
    pass.within(std::span<double>(parts_), 0.0, 1.0);
  }

 private:
  static constexpr std::size_t kAnOctave = 4;
  static constexpr int kFirstOctave = -7;  ///< of the frequency times the interval; constant below
  static constexpr int kLastOctave = 3;
  static constexpr std::size_t kPoints = kAnOctave * static_cast<std::size_t>(kLastOctave - kFirstOctave) + 1;

  double interval_s_ = 1.0;
  std::array<double, kPoints> parts_{};
};

}  // namespace yuragi::wind::blend
