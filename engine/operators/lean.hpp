#pragma once

// How a hanging link stands, in two numbers. For kernel files too: always inlined, as engine/base/kernel.hpp asks.

namespace yuragi {

/// A unit vector of the world. Number is float, or a vector of floats.
template <class Number>
struct Direction {
  Number x;
  Number y;
  Number z;
};

/// Where a link points to that leans by (east, south) from hanging straight down.
///
/// A lean is the vector toward which the link is turned, its length the tangent of half the angle: nearly half the
/// radians while it is small, 1 where the link is level. It is the stereographic projection of the direction from
/// straight up, so that any two numbers give a unit vector with one division and no sine, no angle has a seam, and a
/// lean that changes by d turns the link by 2 d / (1 + lean^2), 2 d at most. (The vector tan(angle/2) is also known as
/// Gibbs' or Rodrigues' vector.)
template <class Number>
[[gnu::always_inline]] inline Direction<Number> hanging_direction(Number east, Number south) noexcept {
  const Number twice = 2.0F / (1.0F + (east * east + south * south));
  return {twice * east, 1.0F - twice, twice * south};
}

}  // namespace yuragi
