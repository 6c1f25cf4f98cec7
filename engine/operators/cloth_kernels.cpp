#include "engine/operators/cloth_kernels.hpp"

#include "engine/base/kernel.hpp"
#include "engine/math/lanes.hpp"
#include "engine/operators/lean.hpp"

namespace yuragi {
namespace {

void propagate(const PropagationKernelArguments& arguments) noexcept {
  const PropagationKernelArguments in = arguments;  // a copy, which no store to `out` can be taken for a change of
  float* const __restrict out = in.out;
  for (std::size_t i = 0; i < in.count; ++i) {
    out[i] = in.base[i] + (in.newer_gain * in.newer[i] + in.older_gain * in.older[i]);
  }
}

void hang(const ClothKernelArguments& arguments) noexcept {
  const ClothKernelArguments in = arguments;
  const std::size_t columns = in.columns;
  const Lanes length_m = same_lanes(in.link_length_m);
  for (std::size_t i = 0; i < columns; i += kLaneCount) {
    const Lanes east = load_lanes(in.rest_lean + i) + load_lanes(in.lean + i);
    const Lanes south = load_lanes(in.rest_lean + columns + i) + load_lanes(in.lean + columns + i);
    const Direction<Lanes> link = hanging_direction(east, south);
    const Lanes turned_x = link.x - load_lanes(in.rest_direction + i);
    const Lanes turned_y = link.y - load_lanes(in.rest_direction + columns + i);
    const Lanes turned_z = link.z - load_lanes(in.rest_direction + 2 * columns + i);
    store_lanes(in.to_x_m + i, load_lanes(in.from_x_m + i) + length_m * turned_x);
    store_lanes(in.to_y_m + i, load_lanes(in.from_y_m + i) + length_m * turned_y);
    store_lanes(in.to_z_m + i, load_lanes(in.from_z_m + i) + length_m * turned_z);
  }
}

}  // namespace

const ClothKernels YURAGI_ROW_NAME(cloth_kernels) = {propagate, hang};

}  // namespace yuragi
