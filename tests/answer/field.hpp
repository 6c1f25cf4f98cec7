#pragma once

#include <vector>

#include "tests/answer/series.hpp"
#include "tests/answer/tracks.hpp"

namespace yuragi::answer {

/// A place in a field, and what was measured there.
struct FieldPoint {
  double along_m = 0.0;   ///< downwind
  double across_m = 0.0;  ///< to the side
  Series values;
};

/// How a pattern goes downwind over a field: pairs of points that are `distance_m` apart downwind, and side by side
/// hardly at all.
struct FieldPairs {
  double distance_m = 1.0;
  double along_tolerance_m = 0.1;
  double across_tolerance_m = 0.1;
  std::size_t most = 24;  ///< pairs
};

/// The speed of the pattern: the pairs' mean distance over the lag at which their mean correlation is largest. Infinite
/// where that lag is not above 0; NaN without pairs. Lags up to distance / slowest are looked at.
double field_speed_m_s(const std::vector<FieldPoint>& points, const FieldPairs& pairs, double rate_hz,
                       double slowest_m_s);

}  // namespace yuragi::answer
