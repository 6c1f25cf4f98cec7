#include "tests/answer/figures.hpp"

namespace yuragi::answer {

std::optional<double> value_of(const Figures& figures, std::string_view name) {
  for (const Figure& figure : figures) {
    if (figure.name == name) return figure.value;
  }
  return std::nullopt;
}

std::vector<Bound> scaled(std::span<const Bound> bounds, double factor) {
  std::vector<Bound> all(bounds.begin(), bounds.end());
  for (Bound& bound : all) {
    for (Range& range : bound.ranges) range = {factor * range.low, factor * range.high};
  }
  return all;
}

}  // namespace yuragi::answer
