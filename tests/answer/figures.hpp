#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/answer/test_wind.hpp"

namespace yuragi::answer {

/// A figure of a record.
struct Figure {
  std::string name;
  double value = 0.0;
};
using Figures = std::vector<Figure>;

/// The one of this name.
std::optional<double> value_of(const Figures& figures, std::string_view name);

/// What a figure may be, both limits included. None: it is shown, and not judged.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  bool is_any() const { return low == -std::numeric_limits<double>::infinity() && high == -low; }
};
inline constexpr Range kAny = {};
constexpr Range at_least(double low) {
  return {.low = low};
}
constexpr Range at_most(double high) {
  return {.high = high};
}

/// A row of a table: a figure, and its range at each Beaufort number.
struct Bound {
  std::string_view figure;
  std::string_view unit;
  int decimals = 2;
  std::array<Range, kBeauforts> ranges = {};
};

/// The same rows, all limits times a factor.
std::vector<Bound> scaled(std::span<const Bound> bounds, double factor);

}  // namespace yuragi::answer
