#include "engine/operators/cloth_kernels.hpp"

#include "engine/base/kernel.hpp"
#include "engine/math/lanes.hpp"
#include "engine/operators/lean.hpp"

namespace yuragi::operators {
namespace {

void propagate(const PropagationKernelArguments& arguments) noexcept {
  const PropagationKernelArguments in = arguments;
  float* const __restrict out = in.out;
  for (std::size_t i = 0; i < in.count; ++i) {
    out[i] = in.base[i] + (in.newer_gain * in.newer[i] + in.older_gain * in.older[i]);
  }
}

/// Lanes of columns run down the whole band, so that their positions stay in registers.
void hang(const ClothKernelArguments& arguments) noexcept {
  const ClothKernelArguments in = arguments;
  const std::size_t columns = in.columns;
  const math::Lanes twice_length_m = math::same_lanes(in.twice_link_length_m);
  for (std::size_t i = 0; i < columns; i += math::kLaneCount) {
    const LinkEnd<math::Lanes> rest_m = {math::load_lanes(in.rest_end_m + i),
                                         math::load_lanes(in.rest_end_m + columns + i),
                                         math::load_lanes(in.rest_end_m + 2 * columns + i)};
    math::Lanes x_m = math::load_lanes(in.offset_x_m + i);
    math::Lanes y_m = math::load_lanes(in.offset_y_m + i);
    math::Lanes z_m = math::load_lanes(in.offset_z_m + i);
    for (std::size_t link = 0; link < in.links; ++link) {
      const float* const lean = in.lean + link * 2 * columns + i;
      const LinkEnd<math::Lanes> end_m =
          link_end(math::load_lanes(lean), math::load_lanes(lean + columns), twice_length_m);
      x_m = x_m + (end_m.east - rest_m.east);
      y_m = y_m + (rest_m.down - end_m.down);
      z_m = z_m + (end_m.south - rest_m.south);
      const std::size_t to = (link + 1) * columns + i;
      math::store_lanes(in.offset_x_m + to, x_m);
      math::store_lanes(in.offset_y_m + to, y_m);
      math::store_lanes(in.offset_z_m + to, z_m);
    }
  }
}

}  // namespace

const ClothKernels YURAGI_ROW_NAME(cloth_kernels) = {propagate, hang};

}  // namespace yuragi::operators
