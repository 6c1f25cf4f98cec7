#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"
#include "engine/noise/torus.hpp"
#include "engine/noise/vector_noise.hpp"

namespace yuragi::operators {

/// A shifted noise, and the places at which to read it: phases on the tile's torus. A field that has moved by `offset`
/// is read at place - offset, so that gusts travel downwind.
struct NoiseLayer {
  const noise::Tile2* tile = nullptr;
  std::span<const std::uint32_t> place_x;
  std::span<const std::uint32_t> place_z;
  noise::TorusPhase offset = {};
  float weight = 1.0F;
  std::span<const float> weights = {};  ///< of each place, multiplied by `weight`; empty: 1
};

/// The sampling operator: reads shifted noise at many places and scales it for the projection, out = clamp(bias + scale
/// * sum of weight * noise(place - offset), low, high) (Chiba, section 2-2 (2)).
///
/// One layer is the paper's; two tiles of different size and direction keep a repeat from being seen (engine/METHOD.md
/// M10, D7); separate octaves, added up, make a noise whose spectrum can change. One value for each place (one per
/// strand, which bends as a whole). Owns nothing; `out` overlaps no input. Thread-safe: jobs with different `out`, yes.
/// Realtime-safe: yes. Every SIMD row computes the same bits, and layers are added in their order. The weight is the
/// layer's, or the layer's times the place's. A place's weight is used as it is: finite. Cost: about 2 ns a place and
/// layer.
struct SampleJob {
  static constexpr std::size_t kMaxLayers = 64;

  std::span<const NoiseLayer> layers;
  float scale = 1.0F;
  float bias = 0.0F;
  float low = -std::numeric_limits<float>::infinity();
  float high = std::numeric_limits<float>::infinity();
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> out;

  enum class Problem : std::uint8_t {
    kNone,
    kLayerCount,       ///< none, or more than kMaxLayers
    kTileNotReadable,  ///< none, or is_readable() is false
    kSizesDiffer,      ///< place_x, place_z, weights (if there are any) and out
    kRangeNotNumber,   ///< a weight, scale or bias is not finite, or low and high are not in order
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

/// A shifted noise vector, and the places at which it is read: as a NoiseLayer. `ahead`: a unit vector on the tile's
/// axes; a vector is split into its part along that one and its part to the left of it (from x to -z). If it turns
/// (noise::VectorNoise2), it is cosine * tile + sine * quarter.
///
/// The strength of a layer at a place can depend on the layers before it: strength + strength_per_fall_s * F, F being
/// the sum of their decrease ahead, -d(along)/d(ahead), m/s per metre. For a field that moves ahead, F is the rate at
/// which the wind rises at a fixed place. A layer adds to F if its samples_per_m is not 0.
struct VectorLayer {
  const noise::VectorTile2* tile = nullptr;
  const noise::VectorTile2* quarter = nullptr;  ///< as large as `tile`; null: only the tile
  float cosine = 1.0F, sine = 0.0F;
  std::span<const std::uint32_t> place_x;
  std::span<const std::uint32_t> place_z;
  noise::TorusPhase offset = {};
  float ahead_x = 1.0F, ahead_z = 0.0F;
  float along = 1.0F, across = 1.0F;
  std::span<const float> along_weights = {};  ///< of each place, multiplied by `along`; empty: 1
  std::span<const float> across_weights = {};
  float strength = 1.0F, strength_per_fall_s = 0.0F;
  float samples_per_m = 0.0F;
};

/// The sampling operator for noise vectors: adds up layers at many places, out_along = sum of along * noise(place -
/// offset) . ahead, and the same to the left. Both components of a layer are read together, because finding the samples
/// costs as much as reading them. Owns nothing; no output overlaps an input or the other output. Thread-safe: jobs with
/// different outputs, yes. Realtime-safe: yes. Every SIMD row computes the same bits, and layers are added in their
/// order.
struct VectorSampleJob {
  static constexpr std::size_t kMaxLayers = 64;

  std::span<const VectorLayer> layers;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> out_along;
  std::span<float> out_across;

  enum class Problem : std::uint8_t {
    kNone,
    kLayerCount,       ///< more than kMaxLayers
    kTileNotReadable,  ///< none, not is_readable(), or the components differ in size
    kSizesDiffer,      ///< places, weights (if there are any) and outputs
    kWeightNotFinite,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate(). Without layers: zeros.
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
