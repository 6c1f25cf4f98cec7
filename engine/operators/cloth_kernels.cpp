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

/// Lanes of columns go down the whole band, so that where they are stays in registers.
void hang(const ClothKernelArguments& arguments) noexcept {
  const ClothKernelArguments in = arguments;
  const std::size_t columns = in.columns;
  const Lanes length_m = same_lanes(in.link_length_m);
  for (std::size_t i = 0; i < columns; i += kLaneCount) {
    const Lanes rest_x = load_lanes(in.rest_direction + i);
    const Lanes rest_y = load_lanes(in.rest_direction + columns + i);
    const Lanes rest_z = load_lanes(in.rest_direction + 2 * columns + i);
    Lanes x_m = load_lanes(in.offset_x_m + i);
    Lanes y_m = load_lanes(in.offset_y_m + i);
    Lanes z_m = load_lanes(in.offset_z_m + i);
    for (std::size_t link = 0; link < in.links; ++link) {
      const float* const lean = in.lean + link * 2 * columns + i;
      const Direction<Lanes> turned = hanging_direction(load_lanes(lean), load_lanes(lean + columns));
      x_m = x_m + length_m * (turned.x - rest_x);
      y_m = y_m + length_m * (turned.y - rest_y);
      z_m = z_m + length_m * (turned.z - rest_z);
      const std::size_t to = (link + 1) * columns + i;
      store_lanes(in.offset_x_m + to, x_m);
      store_lanes(in.offset_y_m + to, y_m);
      store_lanes(in.offset_z_m + to, z_m);
    }
  }
}

}  // namespace

const ClothKernels YURAGI_ROW_NAME(cloth_kernels) = {propagate, hang};

}  // namespace yuragi
