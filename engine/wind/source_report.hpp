#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "engine/wind/wind_reading.hpp"

namespace yuragi::wind {

/// How a source of readings does, seen from the estimator. The stream (pose.fbs, SensorHealth) has the same in the same
/// order.
enum class SourceHealth : std::uint8_t {
  kSilent,  ///< has not spoken yet
  kLive,
  kStale,  ///< silent for longer than its measured interval, or other knowledge of it, explains
};
inline constexpr std::size_t kSourceHealthCount = 3;

struct SourceReport {
  SourceHealth health = SourceHealth::kSilent;
  double interval_s = 0.0;  ///< measured: between new readings; 0 before the second reading
  double age_s = 0.0;       ///< of its last reading
  bool is_overdue = false;  ///< live, but beyond its interval: its silence is explained otherwise
  std::optional<Reading> last;
};

}  // namespace yuragi::wind
