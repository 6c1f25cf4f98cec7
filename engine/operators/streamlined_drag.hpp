#pragma once

// The force of the wind on a plant. Also for kernel files: always inlined, as engine/base/kernel.hpp requires.

namespace yuragi::operators {

/// The drag of a crown that yields to the wind: F = S / (1 + S)^(3/8), S = (wind / streamline_speed)^2. Without a unit;
/// 0.77 at that speed. Square roots and a quotient alone: the same bits on every machine.
///
/// In a weak wind it grows with the square of the speed, like the drag of a stiff body. Above the streamline speed
/// twigs and leaves fold together, and it grows as U^(2 + E) with Vogel's exponent E = -3/4, without a limit. (Vogel
/// 1989, "Drag and reconfiguration of broad leaves in high winds": -0.2 to -1.2, as trees have by de Langre 2008,
/// "Effects of wind on plants". A multiple of 1/8 needs no logarithm.)
[[gnu::always_inline]] inline float streamlined_drag(float speed_square) noexcept {
  const float fourth_root = __builtin_sqrtf(__builtin_sqrtf(1.0F + speed_square));
  return speed_square / (fourth_root * __builtin_sqrtf(fourth_root));
}

}  // namespace yuragi::operators
