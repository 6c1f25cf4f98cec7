#include "tests/answer/field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace yuragi::answer {

double field_speed_m_s(const std::vector<FieldPoint>& points, const FieldPairs& pairs, double rate_hz,
                       double slowest_m_s) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double along_m = points[j].along_m - points[i].along_m;
      const double across_m = points[j].across_m - points[i].across_m;
      if (std::abs(along_m - pairs.distance_m) <= pairs.along_tolerance_m &&
          std::abs(across_m) <= pairs.across_tolerance_m) {
        found.emplace_back(i, j);
      }
    }
  }
  if (found.empty()) return std::numeric_limits<double>::quiet_NaN();

  // A lag as long the other way is looked at too: what does not travel shall not seem to.
  const auto most = static_cast<int>(std::ceil(pairs.distance_m / slowest_m_s * rate_hz)) + 1;
  std::vector<double> sum(static_cast<std::size_t>(2 * most + 1), 0.0);
  double distance_m = 0.0;
  const std::vector<std::size_t> taken = spread(found.size(), pairs.most);
  for (const std::size_t pair : taken) {
    const auto& [first, second] = found[pair];
    const std::vector<double> one = lagged_correlations(points[first].values, points[second].values, -most, most);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += one[i];
    distance_m += (points[second].along_m - points[first].along_m) / static_cast<double>(taken.size());
  }
  const Lag lag = largest(sum, -most, rate_hz);
  return lag.seconds > 0.0 ? distance_m / lag.seconds : std::numeric_limits<double>::infinity();
}

}  // namespace yuragi::answer
