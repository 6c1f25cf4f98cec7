#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi::noise {

/// The meaning of an exponent beta. In one dimension both are the same.
enum class BetaMeaning : std::uint8_t {
  kTransect,  ///< exponent of the spectrum along a straight line through the field, as an anemometer sees it
  kRadial,    ///< exponent of each Fourier mode's power, |k|^-beta: the paper taken literally
};
inline constexpr std::array<std::string_view, 2> kBetaMeaningNames = {"transect", "radial"};

/// The parameters of a noise. Everything except the size has a default.
struct Spec {
  std::size_t size = 0;     ///< samples an edge: a power of two, 8 to kMaxNoiseSize1, 2 or 3 (for the dimensions)
  double beta = 5.0 / 3.0;  ///< 0 (white) to 8, see kMinTransectBeta2; 5/3 is turbulent wind (Kolmogorov 1941; Simiu)
  BetaMeaning meaning = BetaMeaning::kTransect;
  std::uint64_t seed = 0;
  /// Integral length scale of gusts, L, as a part of the edge: L = 0.1 on a tile of period 256 m is 25.6 m. Waves much
  /// longer than L have no more power than those of about L. 0 (or infinity): no limit, a pure 1/f^beta.
  double integral_scale = 0.0;
  /// Limits to waves from `from_cycles` up to, not including, `to_cycles` an edge: at least an octave, or all of them.
  double from_cycles = 0.0;
  double to_cycles = std::numeric_limits<double>::infinity();
};

inline constexpr std::size_t kMinNoiseSize = 8;
inline constexpr std::size_t kMaxNoiseSize1 = std::size_t{1} << 22U;
inline constexpr std::size_t kMaxNoiseSize2 = 4096;
inline constexpr std::size_t kMaxNoiseSize3 = 256;
inline constexpr double kMaxNoiseBeta = 8.0;
/// The minimum beta of a transect in two dimensions and in three. A line cut at wave number k adds up the modes of all
/// wave vectors that lie on a line or plane beside it, and these sums give k^-beta only if they converge: for beta
/// above 0, less k^beta / K^beta that the modes beyond the shortest wave, K, would have added. So a flat transect
/// becomes far too steep, 0.27 for 0 in a square of 512. From these values on the slope from 4 cycles an edge to a
/// sixteenth of the size is within 0.1 of beta (squares of 512, cubes of 256 and more).
inline constexpr double kMinTransectBeta2 = 0.6;
inline constexpr double kMinTransectBeta3 = 1.0;
inline constexpr double kMinNoiseIntegralScale = 1e-6;  ///< besides 0

/// The reason why a noise cannot be made.
enum class Error : std::uint8_t {
  kSizeNotAllowed,
  kBetaOutOfRange,
  kTransectTooFlat,  ///< beta is below kMinTransectBeta2 or kMinTransectBeta3
  kIntegralScaleOutOfRange,
  kBandOutOfRange,
};

std::string_view name_of(Error error) noexcept;

/// One sentence for people: what is allowed.
std::string_view explain(Error error) noexcept;

[[noreturn]] inline void throw_exception_from_error(Error error, const boost::source_location&) {
  throw std::invalid_argument(std::string(explain(error)));
}

/// The exponent b of a mode's power, |F(k)|^2 ~ |k|^-b, for `beta` in a field of `dims` dimensions. A line cut through
/// a field whose modes fall as |k|^-b has a spectrum that falls as k^-(b - (dims - 1)), so kTransect adds dims - 1.
double mode_exponent(int dims, double beta, BetaMeaning meaning) noexcept;

}  // namespace yuragi::noise
