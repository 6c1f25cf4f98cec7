#include "engine/noise/noise_spec.hpp"

namespace yuragi::noise {

std::string_view name_of(Error error) noexcept {
  switch (error) {
    case Error::kSizeNotAllowed:
      return "size-not-allowed";
    case Error::kBetaOutOfRange:
      return "beta-out-of-range";
    case Error::kTransectTooFlat:
      return "transect-too-flat";
    case Error::kIntegralScaleOutOfRange:
      return "integral-scale-out-of-range";
    case Error::kBandOutOfRange:
      return "band-out-of-range";
  }
  return "?";
}

std::string_view explain(Error error) noexcept {
  switch (error) {
    case Error::kSizeNotAllowed:
      return "the size must be a power of two: 8 to 4194304 in one dimension, 8 to 4096 in two, 8 to 256 in three";
    case Error::kBetaOutOfRange:
      return "beta must be a number from 0 to 8";
    case Error::kTransectTooFlat:
      return "along a line, noise of two dimensions falls as 1/f^0.6 or more steeply, of three as 1/f or more steeply; "
             "flatter noise is made with beta as the exponent of each mode (radial), or in one dimension";
    case Error::kIntegralScaleOutOfRange:
      return "the integral scale must be 0 (none) or a part of the edge of at least 0.000001";
    case Error::kBandOutOfRange:
      return "the band must be an octave wide or more, end above 1 cycle an edge and begin at half the size or before";
  }
  return "?";
}

double mode_exponent(int dims, double beta, BetaMeaning meaning) noexcept {
  return meaning == BetaMeaning::kTransect ? beta + (dims - 1) : beta;
}

}  // namespace yuragi::noise
