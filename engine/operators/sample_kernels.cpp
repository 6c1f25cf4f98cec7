#include <cstdint>

#include "engine/base/kernel.hpp"
#include "engine/math/lanes.hpp"
#include "engine/noise/torus_read.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi::operators {
namespace {

/// Places are read this many at a time: positions and results are computed in SIMD lanes, and only the loads are done
/// one by one (a gather instruction is slower).
constexpr std::size_t kAtOnce = 16;

/// The positions of some places on a tile.
struct Cells {
  alignas(64) std::uint32_t north[kAtOnce], south[kAtOnce];  ///< of the western sample, in the tile
  alignas(64) float x_fraction[kAtOnce], z_fraction[kAtOnce];
};

/// The samples around them: from west to east, the first in the low half.
struct Pairs {
  alignas(64) std::uint64_t north[kAtOnce], south[kAtOnce];
};

[[gnu::always_inline]] inline std::uint64_t load_pair(const float* west) noexcept {
  std::uint64_t pair;
  __builtin_memcpy(&pair, west, sizeof pair);
  return pair;
}

/// The same if the row can end between the two: then the east sample is the row's first. `last`: index of a row's last
/// sample.
[[gnu::always_inline]] inline std::uint64_t load_pair_around(const float* tile, std::uint32_t west,
                                                             std::uint32_t last) noexcept {
  const std::uint32_t east = (west & ~last) | ((west + 1U) & last);
  return __builtin_bit_cast(std::uint32_t, tile[west]) |
         static_cast<std::uint64_t>(__builtin_bit_cast(std::uint32_t, tile[east])) << 32U;
}

[[gnu::always_inline]] inline float western(std::uint64_t pair) noexcept {
  return __builtin_bit_cast(float, static_cast<std::uint32_t>(pair));
}
[[gnu::always_inline]] inline float eastern(std::uint64_t pair) noexcept {
  return __builtin_bit_cast(float, static_cast<std::uint32_t>(pair >> 32U));
}

[[gnu::always_inline]] inline float weight_at(float weight, const float* of_places, std::size_t place) noexcept {
  return of_places == nullptr ? weight : weight * of_places[place];
}

/// Computes the positions of kAtOnce places on a layer's tile. Returns whether one of them is in the last column, whose
/// east neighbour is the first.
[[gnu::always_inline]] inline bool find_cells(const SampleKernelPlaces& places, std::size_t begin, Cells& at) noexcept {
  const std::uint32_t last = (1U << places.log2_size) - 1U;
  std::uint32_t wraps = 0;
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    const noise::TorusCell x = noise::torus_cell(places.x[begin + i] - places.offset_x, places.log2_size);
    const noise::TorusCell z = noise::torus_cell(places.z[begin + i] - places.offset_z, places.log2_size);
    at.north[i] = (z.first << places.log2_size) + x.first;
    at.south[i] = (z.second << places.log2_size) + x.first;
    at.x_fraction[i] = x.fraction;
    at.z_fraction[i] = z.fraction;
    wraps |= x.first == last ? 1U : 0U;
  }
  return wraps != 0;
}

/// A cell's two samples are side by side in the tile, except in the last column: if one of the places is there
/// (`wraps`), all are loaded one by one.
[[gnu::always_inline]] inline void load_pairs(const float* tile, unsigned log2_size, const Cells& at, bool wraps,
                                              Pairs& pairs) noexcept {
  if (!wraps) {
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      pairs.north[i] = load_pair(tile + at.north[i]);
      pairs.south[i] = load_pair(tile + at.south[i]);
    }
  } else {
    const std::uint32_t last = (1U << log2_size) - 1U;
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      pairs.north[i] = load_pair_around(tile, at.north[i], last);
      pairs.south[i] = load_pair_around(tile, at.south[i], last);
    }
  }
}

[[gnu::always_inline]] inline float value_at(const Pairs& pairs, const Cells& at, std::size_t i) noexcept {
  const float north = noise::between(western(pairs.north[i]), eastern(pairs.north[i]), at.x_fraction[i]);
  const float south = noise::between(western(pairs.south[i]), eastern(pairs.south[i]), at.x_fraction[i]);
  return noise::between(north, south, at.z_fraction[i]);
}

/// A weight for each of kAtOnce places.
[[gnu::always_inline]] inline void weigh(float weight, const float* of_places, std::size_t begin,
                                         float* weights) noexcept {
  for (std::size_t i = 0; i < kAtOnce; ++i) weights[i] = weight;
  if (of_places != nullptr) {
    for (std::size_t i = 0; i < kAtOnce; ++i) weights[i] *= of_places[begin + i];
  }
}

/// Adds weight * noise at kAtOnce places to `sum`.
[[gnu::always_inline]] inline void add_layer(const SampleKernelLayer& layer, std::size_t begin, float* sum) noexcept {
  Cells at;
  const bool wraps = find_cells(layer.places, begin, at);
  Pairs pairs;
  load_pairs(layer.tile, layer.places.log2_size, at, wraps, pairs);
  alignas(64) float weights[kAtOnce];
  weigh(layer.weight, layer.weights, begin, weights);
  for (std::size_t i = 0; i < kAtOnce; ++i) sum[i] += weights[i] * value_at(pairs, at, i);
}

/// The samples around kAtOnce places of a layer's two components, those of `quarter` mixed in.
struct VectorPairs {
  Pairs x, z, quarter_x, quarter_z;
};

[[gnu::always_inline]] inline noise::TorusSamples samples_of(const Pairs& pairs, std::size_t i) noexcept {
  return {western(pairs.north[i]), eastern(pairs.north[i]), western(pairs.south[i]), eastern(pairs.south[i])};
}

/// The sums over the layers at a place: the two components, and the decrease of `along` ahead, 1/s.
struct VectorSum {
  float along, across, fall;
};

[[gnu::always_inline]] inline VectorSum plus_layer(const VectorSum& sum, const VectorSampleKernelLayer& layer,
                                                   const noise::VectorReading& read, float along_weight,
                                                   float across_weight) noexcept {
  const float strength = layer.strength + layer.strength_per_fall * sum.fall;
  return {sum.along + strength * (along_weight * read.along), sum.across + strength * (across_weight * read.across),
          sum.fall - layer.samples_per_m * (along_weight * read.rise)};
}

/// Adds a layer at kAtOnce places. `has_quarter`: layer.quarter_x is not null.
template <bool has_quarter>
[[gnu::always_inline]] inline void add_vectors(const VectorSampleKernelLayer& layer, std::size_t begin, float* along,
                                               float* across, float* fall) noexcept {
  Cells at;
  const bool wraps = find_cells(layer.places, begin, at);
  const unsigned log2_size = layer.places.log2_size;
  VectorPairs pairs;
  load_pairs(layer.tile_x, log2_size, at, wraps, pairs.x);
  load_pairs(layer.tile_z, log2_size, at, wraps, pairs.z);
  if constexpr (has_quarter) {
    load_pairs(layer.quarter_x, log2_size, at, wraps, pairs.quarter_x);
    load_pairs(layer.quarter_z, log2_size, at, wraps, pairs.quarter_z);
  }
  alignas(64) float along_weights[kAtOnce], across_weights[kAtOnce];
  weigh(layer.along, layer.along_weights, begin, along_weights);
  weigh(layer.across, layer.across_weights, begin, across_weights);
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    noise::TorusSamples x = samples_of(pairs.x, i);
    noise::TorusSamples z = samples_of(pairs.z, i);
    if constexpr (has_quarter) {
      x = noise::mixed(x, layer.cosine, samples_of(pairs.quarter_x, i), layer.sine);
      z = noise::mixed(z, layer.cosine, samples_of(pairs.quarter_z, i), layer.sine);
    }
    const noise::VectorReading read =
        noise::read_vector(x, z, at.x_fraction[i], at.z_fraction[i], layer.ahead_x, layer.ahead_z);
    const VectorSum sum = plus_layer({along[i], across[i], fall[i]}, layer, read, along_weights[i], across_weights[i]);
    along[i] = sum.along;
    across[i] = sum.across;
    fall[i] = sum.fall;
  }
}

/// Number is float or Lanes.
template <class Number>
[[gnu::always_inline]] inline Number scaled(const SampleKernelArguments& in, Number noise) noexcept {
  const Number low = in.low - Number{};
  const Number high = in.high - Number{};
  const Number value = in.bias + in.scale * noise;
  const Number above = value < low ? low : value;
  return above > high ? high : above;
}

/// `known_layers`: their number, if the loop over them is to be unrolled; 0: in.layer_count.
template <std::size_t known_layers>
[[gnu::always_inline]] inline void sample_all(const SampleKernelArguments& in) noexcept {
  const std::size_t layers = known_layers > 0 ? known_layers : in.layer_count;
  std::size_t i = 0;
  for (; i + kAtOnce <= in.count; i += kAtOnce) {
    alignas(64) float sum[kAtOnce] = {};
    for (std::size_t layer = 0; layer < layers; ++layer) add_layer(in.layers[layer], i, sum);
    for (std::size_t lane = 0; lane < kAtOnce; lane += math::kLaneCount) {
      math::store_lanes(in.out + i + lane, scaled(in, math::load_lanes(sum + lane)));
    }
  }
  for (; i < in.count; ++i) {
    float sum = 0.0F;
    for (std::size_t index = 0; index < layers; ++index) {
      const SampleKernelLayer& layer = in.layers[index];
      sum += weight_at(layer.weight, layer.weights, i) *
             noise::read_bilinear(layer.tile, layer.places.log2_size, layer.places.x[i] - layer.places.offset_x,
                                  layer.places.z[i] - layer.places.offset_z);
    }
    in.out[i] = scaled(in, sum);
  }
}

void sample(const SampleKernelArguments& arguments) noexcept {
  const SampleKernelArguments in = arguments;  // a copy, which stores to `out` cannot change
  switch (in.layer_count) {
    case 1:
      return sample_all<1>(in);
    case 2:
      return sample_all<2>(in);
    default:
      return sample_all<0>(in);
  }
}

/// The same at one place.
[[gnu::always_inline]] inline VectorSum plus_vector(const VectorSum& sum, const VectorSampleKernelLayer& layer,
                                                    std::size_t place) noexcept {
  const noise::TorusCorners at =
      noise::torus_corners(layer.places.log2_size, layer.places.x[place] - layer.places.offset_x,
                           layer.places.z[place] - layer.places.offset_z);
  const noise::VectorTiles tiles = {layer.tile_x,    layer.tile_z, layer.quarter_x,
                                    layer.quarter_z, layer.cosine, layer.sine};
  const noise::VectorReading read = noise::read_vector(tiles, at, layer.ahead_x, layer.ahead_z);
  return plus_layer(sum, layer, read, weight_at(layer.along, layer.along_weights, place),
                    weight_at(layer.across, layer.across_weights, place));
}

void sample_vectors(const VectorSampleKernelArguments& arguments) noexcept {
  const VectorSampleKernelArguments in = arguments;  // as above
  std::size_t i = 0;
  for (; i + kAtOnce <= in.count; i += kAtOnce) {
    alignas(64) float along[kAtOnce] = {};
    alignas(64) float across[kAtOnce] = {};
    alignas(64) float fall[kAtOnce] = {};
    for (std::size_t index = 0; index < in.layer_count; ++index) {
      const VectorSampleKernelLayer& layer = in.layers[index];
      if (layer.quarter_x != nullptr) {
        add_vectors<true>(layer, i, along, across, fall);
      } else {
        add_vectors<false>(layer, i, along, across, fall);
      }
    }
    for (std::size_t lane = 0; lane < kAtOnce; ++lane) {
      in.out_along[i + lane] = along[lane];
      in.out_across[i + lane] = across[lane];
    }
  }
  for (; i < in.count; ++i) {
    VectorSum sum = {};
    for (std::size_t index = 0; index < in.layer_count; ++index) sum = plus_vector(sum, in.layers[index], i);
    in.out_along[i] = sum.along;
    in.out_across[i] = sum.across;
  }
}

}  // namespace

const SampleKernels YURAGI_ROW_NAME(sample_kernels) = {sample, sample_vectors};

}  // namespace yuragi::operators
