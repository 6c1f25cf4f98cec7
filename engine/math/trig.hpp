#pragma once

#include <cstdint>

namespace yuragi::math {

/// Number is float, or a vector of floats (engine/math/lanes.hpp).
template <class Number>
struct SinCos {
  Number sin;
  Number cos;
};

/// Sine and cosine of an angle of magnitude up to pi/4, by polynomial: the second half of sin_cos(), which
/// describes the rest. Absolute error below 1.2e-7.
template <class Number>
[[gnu::always_inline]] inline SinCos<Number> sin_cos_within_quarter_pi(Number x) noexcept {
  const Number xx = x * x;
  const Number sin_tail = xx * (xx * -0x1.98d89p-13F + 0x1.1105aep-7F) - 0x1.555554p-3F;
  const Number cos_tail = xx * (xx * 0x1.9b762ep-16F - 0x1.6c120cp-10F) + 0x1.555554p-5F;
  return {x + x * xx * sin_tail, xx * (xx * cos_tail - 0.5F) + 1.0F};
}

/// Sine and cosine of one angle at once, by polynomial: the same bits on every machine and in every SIMD row, and no
/// call into libm, so that a loop over floats is vectorised. Bits is the unsigned integer as wide as Number.
///
/// Angle in radians, magnitude up to 50: absolute error below 1.5e-7. Beyond that the error grows with the angle, and
/// above 1e6 the result means nothing. sin_cos(0) is exactly (0, 1). Needs the default rounding mode.
/// Thread-safe and realtime-safe: yes.
///
/// May be used in kernel files (engine/base/kernel.hpp): it is always inlined, so no copy of it exists that the linker
/// could take from the AVX row for the base row. Keep it so, and call nothing from here that is not a builtin.
/// Source: argument reduction after Cody and Waite 1980, "Software Manual for the Elementary Functions"; the
/// polynomials are minimax fits (Remez) of sin x - x and cos x - 1 + x^2 / 2 on [0, pi/4].
template <class Bits = std::uint32_t, class Number>
[[gnu::always_inline]] inline SinCos<Number> sin_cos(Number angle_rad) noexcept {
  // The nearest multiple of pi/2: adding 1.5 * 2^23 leaves the integer in the low bits, in two's complement.
  constexpr float kTwoOverPi = 0x1.45f306p-1F;
  constexpr float kRound = 0x1.8p23F;
  const Number shifted = angle_rad * kTwoOverPi + kRound;
  const Bits quadrant = __builtin_bit_cast(Bits, shifted);
  const Number quarters = shifted - kRound;

  // The remaining angle, within pi/4. pi/2 is split into two parts: the first has 17 bits, so its product is exact.
  constexpr float kHalfPiHigh = 0x1.921fp0F;
  constexpr float kHalfPiLow = 0x1.6a8886p-17F;
  const Number x = (angle_rad - quarters * kHalfPiHigh) - quarters * kHalfPiLow;
  const auto [sin_x, cos_x] = sin_cos_within_quarter_pi(x);

  // Each quarter turn swaps the two and changes one sign.
  const auto swapped = (quadrant & 1U) != 0U;
  const Number sine = swapped ? cos_x : sin_x;
  const Number cosine = swapped ? sin_x : cos_x;
  const Bits sin_sign = (quadrant & 2U) << 30U;
  const Bits cos_sign = ((quadrant + 1U) & 2U) << 30U;
  return {__builtin_bit_cast(Number, __builtin_bit_cast(Bits, sine) ^ sin_sign),
          __builtin_bit_cast(Number, __builtin_bit_cast(Bits, cosine) ^ cos_sign)};
}

}  // namespace yuragi::math
