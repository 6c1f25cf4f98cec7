#include "tests/answer/swing.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace yuragi::answer {

Swing swing_of(const Series& way_m, double rate_hz) {
  const auto off_m = [&](std::size_t i) { return static_cast<double>(way_m[i] - way_m.back()); };
  const double sign = off_m(0) < 0.0 ? -1.0 : 1.0;
  std::vector<std::size_t> turns;
  std::size_t i = 0;
  while (i < way_m.size() && sign * off_m(i) > 0.0) ++i;
  double side = -sign;
  while (turns.size() < 2 && i < way_m.size()) {
    std::size_t top = i;
    for (; i < way_m.size() && side * off_m(i) >= 0.0; ++i) {
      if (side * off_m(i) > side * off_m(top)) top = i;
    }
    turns.push_back(top);
    side = -side;
  }
  Swing swing;
  if (turns.size() < 2 || off_m(turns[1]) == 0.0) return swing;
  swing.frequency_hz = 0.5 * rate_hz / static_cast<double>(turns[1] - turns[0]);
  const double left = std::log(std::abs(off_m(turns[0]) / off_m(turns[1])));  // logarithmic decrement of half a period
  swing.damping = left / std::hypot(left, std::numbers::pi);
  return swing;
}

}  // namespace yuragi::answer
