#include "engine/operators/grid_sample_kernels.hpp"

#include "engine/base/kernel.hpp"
#include "engine/math/lanes.hpp"
#include "engine/noise/torus_read.hpp"

// clang has no __builtin_shuffle; without AVX2 it would consist of single loads.
#if defined(__AVX2__) && !defined(__clang__)
#define YURAGI_PICKS_LANES 1
#else
#define YURAGI_PICKS_LANES 0
#endif

namespace yuragi::operators {
namespace {

/// The grid is processed in strips of this many columns, each from the first row to the last.
constexpr std::size_t kStrip = 16;

/// The positions of a strip's columns on a layer's tile.
struct StripColumns {
  alignas(64) std::uint32_t west[kStrip];
  alignas(64) float fraction[kStrip];
  bool wraps = false;    ///< a column is after the last sample, whose east neighbour is the first
  bool is_near = false;  ///< all samples for a register are in its window
  /// The begin of the 2 kLaneCount samples that contain those for a register.
  std::uint32_t window[kStrip / math::kLaneCount];
};

/// Two samples side by side, the western one in the low half.
[[gnu::always_inline]] inline std::uint64_t load_both(const float* west) noexcept {
  std::uint64_t both;
  __builtin_memcpy(&both, west, sizeof both);
  return both;
}
[[gnu::always_inline]] inline float west_of(std::uint64_t both) noexcept {
  return __builtin_bit_cast(float, static_cast<std::uint32_t>(both));
}
[[gnu::always_inline]] inline float east_of(std::uint64_t both) noexcept {
  return __builtin_bit_cast(float, static_cast<std::uint32_t>(both >> 32U));
}

#if YURAGI_PICKS_LANES
/// window[index] in each lane; an index is below 2 kLaneCount.
[[gnu::always_inline]] inline math::Lanes pick(const float* window, math::LaneBits index) noexcept {
  return __builtin_shuffle(math::load_lanes(window), math::load_lanes(window + math::kLaneCount), index);
}
#endif

[[gnu::always_inline]] inline void place_columns(const GridSampleKernelLayer& layer, std::size_t first,
                                                 StripColumns& columns) noexcept {
  const std::uint32_t last = (1U << layer.log2_size) - 1U;
  std::uint32_t wraps = 0;
  for (std::size_t i = 0; i < kStrip; ++i) {
    const noise::TorusCell x = noise::torus_cell(layer.column_x[first + i] - layer.offset_x, layer.log2_size);
    columns.west[i] = x.first;
    columns.fraction[i] = x.fraction;
    wraps |= x.first == last ? 1U : 0U;
  }
  columns.wraps = wraps != 0;
#if YURAGI_PICKS_LANES
  constexpr std::uint32_t kWindow = 2 * math::kLaneCount;
  const std::uint32_t last_window = last + 1U >= kWindow ? last + 1U - kWindow : 0U;
  for (std::size_t i = 0; i < kStrip; i += math::kLaneCount) {
    columns.window[i / math::kLaneCount] = columns.west[i] < last_window ? columns.west[i] : last_window;
  }
  std::uint32_t far = wraps | (last + 1U < kWindow ? 1U : 0U);
  for (std::size_t i = 0; i < kStrip; ++i) {
    far |= columns.west[i] - columns.window[i / math::kLaneCount] > 2 * math::kLaneCount - 2 ? 1U : 0U;
  }
  columns.is_near = far == 0;
#endif
}

/// Adds weight * noise at the columns of a strip in one row.
[[gnu::always_inline]] inline void add_row(const GridSampleKernelLayer& layer, const StripColumns& columns,
                                           std::size_t first, std::size_t row, float* sum) noexcept {
  const noise::TorusCell z = noise::torus_cell(layer.row_z[row] - layer.offset_z, layer.log2_size);
  const float* const north = layer.tile + (std::size_t{z.first} << layer.log2_size);
  const float* const south = layer.tile + (std::size_t{z.second} << layer.log2_size);
#if YURAGI_PICKS_LANES
  if (columns.is_near) {
    for (std::size_t i = 0; i < kStrip; i += math::kLaneCount) {
      math::LaneBits west;
      __builtin_memcpy(&west, columns.west + i, sizeof west);
      const std::uint32_t begin = columns.window[i / math::kLaneCount];
      west -= begin;
      const math::LaneBits east = west + 1U;
      const math::Lanes fraction = math::load_lanes(columns.fraction + i);
      const math::Lanes north_west = pick(north + begin, west);
      const math::Lanes south_west = pick(south + begin, west);
      const math::Lanes along_north = north_west + fraction * (pick(north + begin, east) - north_west);
      const math::Lanes along_south = south_west + fraction * (pick(south + begin, east) - south_west);
      const math::Lanes noise = along_north + z.fraction * (along_south - along_north);
      math::store_lanes(sum + i, math::load_lanes(sum + i) + layer.weight * noise);
    }
    return;
  }
#endif
  if (columns.wraps) {
    for (std::size_t i = 0; i < kStrip; ++i) {
      sum[i] +=
          layer.weight * noise::read_bilinear(layer.tile, layer.log2_size, layer.column_x[first + i] - layer.offset_x,
                                              layer.row_z[row] - layer.offset_z);
    }
    return;
  }
  alignas(64) std::uint64_t in_north[kStrip];
  alignas(64) std::uint64_t in_south[kStrip];
  for (std::size_t i = 0; i < kStrip; ++i) {
    in_north[i] = load_both(north + columns.west[i]);
    in_south[i] = load_both(south + columns.west[i]);
  }
  for (std::size_t i = 0; i < kStrip; ++i) {
    const float along_north = noise::between(west_of(in_north[i]), east_of(in_north[i]), columns.fraction[i]);
    const float along_south = noise::between(west_of(in_south[i]), east_of(in_south[i]), columns.fraction[i]);
    sum[i] += layer.weight * noise::between(along_north, along_south, z.fraction);
  }
}

void sample_strip(const GridSampleKernelArguments& in, std::size_t first) noexcept {
  StripColumns columns[4];
  for (std::size_t layer = 0; layer < in.layer_count; ++layer) place_columns(in.layers[layer], first, columns[layer]);
  for (std::size_t row = 0; row < in.rows; ++row) {
    alignas(64) float sum[kStrip] = {};
    for (std::size_t layer = 0; layer < in.layer_count; ++layer) {
      add_row(in.layers[layer], columns[layer], first, row, sum);
    }
    __builtin_memcpy(in.out + row * in.columns + first, sum, sizeof sum);
  }
}

void sample(const GridSampleKernelArguments& arguments) noexcept {
  const GridSampleKernelArguments in = arguments;  // a copy, which stores to `out` cannot change
  if (in.columns >= kStrip) {
    for (std::size_t first = 0; first + kStrip < in.columns; first += kStrip) sample_strip(in, first);
    sample_strip(in, in.columns - kStrip);  // a whole strip again, which overlaps the last one
    return;
  }
  for (std::size_t row = 0; row < in.rows; ++row) {
    for (std::size_t column = 0; column < in.columns; ++column) {
      float sum = 0.0F;
      for (std::size_t index = 0; index < in.layer_count; ++index) {
        const GridSampleKernelLayer& layer = in.layers[index];
        sum += layer.weight * noise::read_bilinear(layer.tile, layer.log2_size, layer.column_x[column] - layer.offset_x,
                                                   layer.row_z[row] - layer.offset_z);
      }
      in.out[row * in.columns + column] = sum;
    }
  }
}

}  // namespace

const GridSampleKernels YURAGI_ROW_NAME(grid_sample_kernels) = {sample};

}  // namespace yuragi::operators
