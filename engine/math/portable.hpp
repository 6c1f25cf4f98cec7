#pragma once

#include <cmath>
#include <concepts>
#include <numbers>

namespace yuragi::math {

// Functions that give the same bits on every machine, since a pose's hash depends on them. Those of the C library with
// these names do not: the last bit of std::hypot, std::cbrt and std::exp2 depends on the processor and on the library's
// version. A square root and a product are exact by IEEE 754; std::pow is the same code everywhere in glibc.
// Thread-safe; realtime-safe.

/// The length of a vector. Overflows beyond 1e154 (of floats, 1e19).
template <std::floating_point T>
T length(T x, T y) noexcept {
  return std::sqrt(x * x + y * y);
}
template <std::floating_point T>
T length(T x, T y, T z) noexcept {
  return std::sqrt(x * x + y * y + z * z);
}

/// The cube root of x (0 or more).
inline double cube_root(double x) noexcept {
  return std::pow(x, 1.0 / 3.0);
}

/// 2^x and 10^x. std::pow(2, x) and std::pow(10, x) become different functions in clang (exp2, exp10) and in gcc.
inline double power_of_two(double x) noexcept {
  return std::exp(x * std::numbers::ln2);
}
inline double power_of_ten(double x) noexcept {
  return std::exp(x * std::numbers::ln10);
}

}  // namespace yuragi::math
