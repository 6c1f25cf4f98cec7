#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"
#include "engine/operators/propagation_history.hpp"

namespace yuragi::operators {

/// The projection operator "propagation": link i of n (from 0) takes the value of travel_time * i / (n - 1) ago, times
/// its growth, plus a base that is the same for the whole chain (Chiba, section 2-2 (3), figures 6 and 10: a base sway
/// for the whole cloth, and a noise that runs from the fixed edge to the free one).
///
/// A time and not a number of ticks: fractional, interpolated, and continuous when it changes, so that the motion does
/// not depend on the tick rate. out[link * width + j] = base[j] + growth[link] * history(j, delay of the link); the
/// caller decides on the meaning of the values. `out` can be a part of the links, from first_link on. Owns nothing;
/// `out` overlaps no input. Thread-safe: jobs with different `out`, yes. Realtime-safe: yes. Every SIMD row computes
/// the same bits. Cost: about 0.1 ns a value (x86-64-v3).
struct PropagationJob {
  const PropagationHistory* history = nullptr;
  std::span<const float> base;    ///< history->width() values
  std::span<const float> growth;  ///< one a link, of all links of the chain
  double travel_time_s = 1.0;     ///< from the first link to the last; at least 0
  std::size_t first_link = 0;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> out;  ///< whole rows of history->width(), one per link

  enum class Problem : std::uint8_t {
    kNone,
    kNoHistory,
    kTravelTime,   ///< not a finite number of at least 0
    kSizesDiffer,  ///< base is not as wide as the history, or out is not whole rows
    kNotALink,     ///< out goes beyond the last link
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
