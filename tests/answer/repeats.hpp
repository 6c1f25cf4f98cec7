#pragma once

#include "tests/answer/series.hpp"

namespace yuragi::answer {

/// Where a series is most like itself.
struct Repeat {
  double lag_s = 0.0;
  double correlation = 0.0;
};

/// The largest correlation of a series with itself from `least_s` to half its length later, of what is quicker than
/// 0.1 Hz: what repeats has nearly 1 at its period; what does not, about 3.5 over the root of how many independent
/// swings there are, 0.15 to 0.35 in ten minutes.
Repeat largest_repeat(const Series& series, double rate_hz, double least_s);

/// From here on there is a repeat.
inline constexpr double kRepeats = 0.5;
/// Later than this nothing has the same swing as before.
inline constexpr double kSwing_s = 10.0;

}  // namespace yuragi::answer
