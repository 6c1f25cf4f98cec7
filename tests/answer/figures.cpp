#include "tests/answer/figures.hpp"

namespace yuragi::answer {

std::vector<Bound> scaled(std::span<const Bound> bounds, double factor) {
  std::vector<Bound> all(bounds.begin(), bounds.end());
  for (Bound& bound : all) {
    for (Range& range : bound.ranges) range = {factor * range.low, factor * range.high};
  }
  return all;
}

}  // namespace yuragi::answer
