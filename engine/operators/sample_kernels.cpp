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

[[gnu::always_inline]] inline float scaled(const SampleKernelArguments& in, float noise) noexcept {
  const float value = in.bias + in.scale * noise;
  const float above = value < in.low ? in.low : value;
  return above > in.high ? in.high : above;
}

[[gnu::always_inline]] inline void sample_block(const SampleKernelArguments& in, std::size_t begin) noexcept {
  Corners at;
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    const TorusCell x = torus_cell(in.place_x[begin + i] - in.offset_x, in.log2_size);
    const TorusCell z = torus_cell(in.place_z[begin + i] - in.offset_z, in.log2_size);
    at.north_west[i] = (z.first << in.log2_size) + x.first;
    at.north_east[i] = (z.first << in.log2_size) + x.second;
    at.south_west[i] = (z.second << in.log2_size) + x.first;
    at.south_east[i] = (z.second << in.log2_size) + x.second;
    at.x_fraction[i] = x.fraction;
    at.z_fraction[i] = z.fraction;
  }

  alignas(64) float north_west[kAtOnce], north_east[kAtOnce], south_west[kAtOnce], south_east[kAtOnce];
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    north_west[i] = in.tile[at.north_west[i]];
    north_east[i] = in.tile[at.north_east[i]];
    south_west[i] = in.tile[at.south_west[i]];
    south_east[i] = in.tile[at.south_east[i]];
  }

  for (std::size_t i = 0; i < kAtOnce; ++i) {
    const float north = between(north_west[i], north_east[i], at.x_fraction[i]);
    const float south = between(south_west[i], south_east[i], at.x_fraction[i]);
    in.out[begin + i] = scaled(in, between(north, south, at.z_fraction[i]));
  }
}

void sample(const SampleKernelArguments& arguments) noexcept {
  const SampleKernelArguments in = arguments;  // a copy, which no store to `out` can be taken for a change of
  std::size_t i = 0;
  for (; i + kAtOnce <= in.count; i += kAtOnce) sample_block(in, i);
  for (; i < in.count; ++i) {
    in.out[i] =
        scaled(in, read_bilinear(in.tile, in.log2_size, in.place_x[i] - in.offset_x, in.place_z[i] - in.offset_z));
  }
}

}  // namespace

const SampleKernels YURAGI_ROW_NAME(sample_kernels) = {sample};

}  // namespace yuragi
