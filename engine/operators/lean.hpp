#pragma once

// The direction of a hanging link, in two numbers. Also for kernel files: always inlined, as engine/base/kernel.hpp
// requires.

namespace yuragi::operators {

/// The end of a hanging link, relative to the point its length above its beginning. Number is float, or a vector of
/// floats.
template <class Number>
struct LinkEnd {
  Number east;
  Number down;
  Number south;
};

/// The end of a link that leans by (east, south) from hanging straight down, its length 1: down is 1 - y, so that
/// (east, 1 - down, south) is a unit vector in x, y, z. Twice the length in place of 2 gives it in metres.
///
/// A lean is a vector in the direction of the turn, its length the tangent of half the angle: about half the radians
/// for small angles, 1 for a level link. It is the stereographic projection of the direction from straight up, so that
/// any two numbers give a unit vector with one division and no sine, no angle has a seam, and a lean that changes by d
/// turns the link by 2 d / (1 + lean^2), 2 d at most. (The vector tan(angle/2) is also known as Gibbs' or Rodrigues'
/// vector.)
template <class Number>
[[gnu::always_inline]] inline LinkEnd<Number> link_end(Number east, Number south, Number twice_length) noexcept {
  const Number down = twice_length / (1.0F + (east * east + south * south));
  return {down * east, down, down * south};
}

}  // namespace yuragi::operators
