#pragma once

#include <cstddef>

#include "engine/base/kernel.hpp"

// Internal: between WindTapes and its kernel.

namespace yuragi::wind::ground {

constexpr std::size_t kTapeBandLanes = 16;
constexpr std::size_t kTapeOctaveLanes = 32;

/// The inputs of a place: two samples of a tape, two rows of the kept part over distance, and the position between
/// them.
struct TapeKernelPlace {
  const float* first = nullptr;   ///< lanes of WindSample: bands east, bands north, octaves along, octaves across
  const float* second = nullptr;  ///< the same
  const float* near = nullptr;    ///< lanes of the kept part: bands, octaves
  const float* far = nullptr;
  float fraction = 0.0F;  ///< from the first to the second
  float row_fraction = 0.0F;
  float kept = 1.0F;  ///< besides
};

/// The output of the octave numbered `octave`: a value for each place.
struct TapeKernelOctave {
  std::size_t octave = 0;
  float* along = nullptr;
  float* across = nullptr;
};

struct TapeKernelArguments {
  std::size_t count = 0;  ///< of places
  const TapeKernelPlace* places = nullptr;
  float* east_m_s = nullptr;  ///< null: not asked for
  float* north_m_s = nullptr;
  std::size_t octave_count = 0;
  TapeKernelOctave octaves[kTapeOctaveLanes] = {};
};

struct TapeKernels {
  /// The gusts at one place.
  void (*gusts)(const TapeKernelPlace&, float* east_m_s, float* north_m_s) noexcept;
  /// The factors on all lanes of octaves at one place.
  void (*octaves)(const TapeKernelPlace&, float* along, float* across) noexcept;
  /// Both at many places, to the same bits.
  void (*many)(const TapeKernelArguments&) noexcept;
};
YURAGI_DECLARE_KERNEL_ROWS(TapeKernels, tape_kernels);

}  // namespace yuragi::wind::ground
