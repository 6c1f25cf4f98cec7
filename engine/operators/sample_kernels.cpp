#include "engine/base/kernel.hpp"
#include "engine/noise/torus_read.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi {
namespace {

/// Places are read this many at a time: where they are and what comes of their samples are computed in SIMD lanes, and
/// only the loads between go one by one (a gather instruction is slower).
constexpr std::size_t kAtOnce = 16;

/// The samples around some places.
struct Corners {
  alignas(64) std::uint32_t north_west[kAtOnce], north_east[kAtOnce], south_west[kAtOnce], south_east[kAtOnce];
  alignas(64) float x_fraction[kAtOnce], z_fraction[kAtOnce];
};

/// Adds weight * noise at kAtOnce places to `sum`.
[[gnu::always_inline]] inline void add_layer(const SampleKernelLayer& layer, std::size_t begin, float* sum) noexcept {
  Corners at;
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    const TorusCell x = torus_cell(layer.place_x[begin + i] - layer.offset_x, layer.log2_size);
    const TorusCell z = torus_cell(layer.place_z[begin + i] - layer.offset_z, layer.log2_size);
    at.north_west[i] = (z.first << layer.log2_size) + x.first;
    at.north_east[i] = (z.first << layer.log2_size) + x.second;
    at.south_west[i] = (z.second << layer.log2_size) + x.first;
    at.south_east[i] = (z.second << layer.log2_size) + x.second;
    at.x_fraction[i] = x.fraction;
    at.z_fraction[i] = z.fraction;
  }

  alignas(64) float north_west[kAtOnce], north_east[kAtOnce], south_west[kAtOnce], south_east[kAtOnce];
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    north_west[i] = layer.tile[at.north_west[i]];
    north_east[i] = layer.tile[at.north_east[i]];
    south_west[i] = layer.tile[at.south_west[i]];
    south_east[i] = layer.tile[at.south_east[i]];
  }

  for (std::size_t i = 0; i < kAtOnce; ++i) {
    const float north = between(north_west[i], north_east[i], at.x_fraction[i]);
    const float south = between(south_west[i], south_east[i], at.x_fraction[i]);
    sum[i] += layer.weight * between(north, south, at.z_fraction[i]);
  }
}

[[gnu::always_inline]] inline float scaled(const SampleKernelArguments& in, float noise) noexcept {
  const float value = in.bias + in.scale * noise;
  const float above = value < in.low ? in.low : value;
  return above > in.high ? in.high : above;
}

/// `known_layers`: how many there are, where the loop over them is to be unrolled; 0: as many as `in` says.
template <std::size_t known_layers>
[[gnu::always_inline]] inline void sample_all(const SampleKernelArguments& in) noexcept {
  const std::size_t layers = known_layers > 0 ? known_layers : in.layer_count;
  std::size_t i = 0;
  for (; i + kAtOnce <= in.count; i += kAtOnce) {
    alignas(64) float sum[kAtOnce] = {};
    for (std::size_t layer = 0; layer < layers; ++layer) add_layer(in.layers[layer], i, sum);
    for (std::size_t lane = 0; lane < kAtOnce; ++lane) in.out[i + lane] = scaled(in, sum[lane]);
  }
  for (; i < in.count; ++i) {
    float sum = 0.0F;
    for (std::size_t index = 0; index < layers; ++index) {
      const SampleKernelLayer& layer = in.layers[index];
      sum += layer.weight * read_bilinear(layer.tile, layer.log2_size, layer.place_x[i] - layer.offset_x,
                                          layer.place_z[i] - layer.offset_z);
    }
    in.out[i] = scaled(in, sum);
  }
}

void sample(const SampleKernelArguments& arguments) noexcept {
  const SampleKernelArguments in = arguments;  // a copy, which no store to `out` can be taken for a change of
  switch (in.layer_count) {
    case 1:
      return sample_all<1>(in);
    case 2:
      return sample_all<2>(in);
    default:
      return sample_all<0>(in);
  }
}

}  // namespace

const SampleKernels YURAGI_ROW_NAME(sample_kernels) = {sample};

}  // namespace yuragi
