#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/kernel.hpp"

// Internal: between the jobs of this folder and their kernels.

namespace yuragi::operators {

/// Where a layer is read: on a torus of 2^log2_size samples an edge, at place - offset.
struct SampleKernelPlaces {
  unsigned log2_size = 0;
  const std::uint32_t* x = nullptr;
  const std::uint32_t* z = nullptr;
  std::uint32_t offset_x = 0;
  std::uint32_t offset_z = 0;
};

struct SampleKernelLayer {
  const float* tile = nullptr;
  SampleKernelPlaces places;
  float weight = 1.0F;
  const float* weights = nullptr;  ///< of each place, multiplied by `weight`; null: 1
};

struct SampleKernelArguments {
  std::size_t count = 0;
  std::size_t layer_count = 0;
  SampleKernelLayer layers[64] = {};
  float scale = 0.0F;
  float bias = 0.0F;
  float low = 0.0F;
  float high = 0.0F;
  float* out = nullptr;
};

struct VectorSampleKernelLayer {
  const float* tile_x = nullptr;
  const float* tile_z = nullptr;
  const float* quarter_x = nullptr;  ///< null: the tile alone
  const float* quarter_z = nullptr;
  float cosine = 1.0F;  ///< of the tile
  float sine = 0.0F;    ///< of `quarter`
  SampleKernelPlaces places;
  float ahead_x = 0.0F;  ///< the unit vector of `along`, on the tile's axes
  float ahead_z = 0.0F;
  float along = 1.0F;
  float across = 1.0F;
  const float* along_weights = nullptr;  ///< of each place, multiplied by `along`; null: 1
  const float* across_weights = nullptr;
  float strength = 1.0F;
  float strength_per_fall = 0.0F;
  float samples_per_m = 0.0F;
};

struct VectorSampleKernelArguments {
  std::size_t count = 0;
  std::size_t layer_count = 0;
  VectorSampleKernelLayer layers[64] = {};
  float* out_along = nullptr;
  float* out_across = nullptr;
};

struct BendingKernelArguments {
  std::size_t count = 0;
  const float* strength = nullptr;
  const float* flexibility = nullptr;
  float wind_in_half_bends = 0.0F;  ///< wind speed / half-bend speed
  float bend_east_rad = 0.0F;       ///< the maximum bend, downwind
  float bend_south_rad = 0.0F;
  float* out_east_rad = nullptr;
  float* out_south_rad = nullptr;
};

struct LocalBendingKernelArguments {
  std::size_t count = 0;
  const float* wind_east_m_s = nullptr;
  const float* wind_south_m_s = nullptr;
  const float* strength = nullptr;
  const float* flexibility = nullptr;
  float half_bends_per_m_s = 0.0F;
  float max_bend_rad = 0.0F;
  float* out_east_rad = nullptr;
  float* out_south_rad = nullptr;
};

struct CoatBendingKernelArguments {
  std::size_t count = 0;
  float wind_east_m_s = 0.0F;
  float wind_south_m_s = 0.0F;
  float per_speed_s_m = 0.0F;  ///< 1 / the wind's speed; 0 in calm air
  const float* normal_x = nullptr;
  const float* normal_z = nullptr;
  const float* stroke_along = nullptr;
  const float* stroke_across = nullptr;
  const float* flexibility = nullptr;
  float half_bends_per_m_s = 0.0F;
  float max_bend_rad = 0.0F;
  float stroke_rad = 0.0F;
  float sheltered = 0.0F;
  float* out_east_rad = nullptr;
  float* out_south_rad = nullptr;
};

struct OscillatorKernelArguments {
  std::size_t count = 0;
  float q_from_e = 0.0F;  ///< the exact step: q' = g + q_from_e e + q_from_v v, v' = v_from_e e + v_from_v v
  float q_from_v = 0.0F;
  float v_from_e = 0.0F;
  float v_from_v = 0.0F;
  const float* each_q_from_e = nullptr;  ///< the same of each oscillator, for step_each
  const float* each_q_from_v = nullptr;
  const float* each_v_from_e = nullptr;
  const float* each_v_from_v = nullptr;
  float blend = 0.0F;
  float* value = nullptr;
  float* rate = nullptr;
  float* driven = nullptr;  ///< in: the noise's angle; out: the blend of the two
};

struct SampleKernels {
  void (*sample)(const SampleKernelArguments&) noexcept;
  void (*sample_vectors)(const VectorSampleKernelArguments&) noexcept;
};
YURAGI_DECLARE_KERNEL_ROWS(SampleKernels, sample_kernels);

struct BendingKernels {
  void (*bend)(const BendingKernelArguments&) noexcept;
  void (*bend_locally)(const LocalBendingKernelArguments&) noexcept;
  void (*bend_coat)(const CoatBendingKernelArguments&) noexcept;
};
YURAGI_DECLARE_KERNEL_ROWS(BendingKernels, bending_kernels);

struct OscillatorKernels {
  void (*step)(const OscillatorKernelArguments&) noexcept;       ///< all alike
  void (*step_each)(const OscillatorKernelArguments&) noexcept;  ///< each with its own step
};
YURAGI_DECLARE_KERNEL_ROWS(OscillatorKernels, oscillator_kernels);

}  // namespace yuragi::operators
