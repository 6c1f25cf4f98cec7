#pragma once

#include <numbers>

// The bend of a plant in the wind. Also for kernel files: always inlined, as engine/base/kernel.hpp requires.

namespace yuragi::operators {

/// The share of a plant's maximum bend: s^2 / (1 + s^2), where s is the wind's speed over the speed for half of that
/// bend, and `s_square` is s^2 (at least 0). In a weak wind it grows with the square of the speed, as the drag of the
/// air does; it is 1/2 at s = 1 and never above 1. Written so that each rounding keeps the order: a stronger wind never
/// bends less, not by a bit.
[[gnu::always_inline]] inline float bend_share(float s_square) noexcept {
  return 1.0F - 1.0F / (1.0F + s_square);
}

/// bend_share over s: times the wind's components it gives the share along each, without dividing by a speed that may
/// be 0. `s` is the root of `s_square`.
[[gnu::always_inline]] inline float bend_share_over_s(float s, float s_square) noexcept {
  return s / (1.0F + s_square);
}

/// The maximum slope of the share over s: 3 sqrt(3) / 8, at s = 1 / sqrt(3). As a vector in the wind's plane the bend
/// changes no faster than that times s in any direction.
inline constexpr double kSteepestBendShare = 3.0 * std::numbers::sqrt3 / 8.0;

}  // namespace yuragi::operators
