#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/bend_share.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi::operators {
namespace {

/// In half-bend speeds: limits at which the bend is at its maximum, and below which the square would underflow.
constexpr float kLargest = 1e9F;

void bend(const BendingKernelArguments& in) noexcept {
  // Copies, so that the compiler knows that stores to the outputs do not change them.
  const BendingKernelArguments arguments = in;
  const float* const strength = arguments.strength;
  const float* const flexibility = arguments.flexibility;
  float* const __restrict east = arguments.out_east_rad;
  float* const __restrict south = arguments.out_south_rad;
  for (std::size_t i = 0; i < arguments.count; ++i) {
    const float wind = arguments.wind_in_half_bends * strength[i] * flexibility[i];
    const float blowing = wind > 0.0F ? wind : 0.0F;
    const float s = blowing < kLargest ? blowing : kLargest;
    const float share = bend_share(s * s);
    east[i] = arguments.bend_east_rad * share;
    south[i] = arguments.bend_south_rad * share;
  }
}

void bend_locally(const LocalBendingKernelArguments& in) noexcept {
  const LocalBendingKernelArguments arguments = in;
  const float* const wind_east = arguments.wind_east_m_s;
  const float* const wind_south = arguments.wind_south_m_s;
  const float* const strength = arguments.strength;
  const float* const flexibility = arguments.flexibility;
  float* const __restrict east = arguments.out_east_rad;
  float* const __restrict south = arguments.out_south_rad;
  for (std::size_t i = 0; i < arguments.count; ++i) {
    const float per_m_s = arguments.half_bends_per_m_s * strength[i] * flexibility[i];
    const float blowing = per_m_s * std::sqrt(wind_east[i] * wind_east[i] + wind_south[i] * wind_south[i]);
    const float s = blowing < kLargest ? blowing : kLargest;
    const float bend_per_m_s = arguments.max_bend_rad * per_m_s * bend_share_over_s(s, s * s);
    east[i] = bend_per_m_s * wind_east[i];
    south[i] = bend_per_m_s * wind_south[i];
  }
}

void bend_coat(const CoatBendingKernelArguments& in) noexcept {
  const CoatBendingKernelArguments arguments = in;
  const float* const normal_x = arguments.normal_x;
  const float* const normal_z = arguments.normal_z;
  const float* const stroke_along = arguments.stroke_along;
  const float* const stroke_across = arguments.stroke_across;
  const float* const flexibility = arguments.flexibility;
  float* const __restrict out_east = arguments.out_east_rad;
  float* const __restrict out_south = arguments.out_south_rad;
  const float wind_east = arguments.wind_east_m_s;
  const float wind_south = arguments.wind_south_m_s;
  const float wind_square = wind_east * wind_east + wind_south * wind_south;
  const float toward_east = wind_east * arguments.per_speed_s_m;
  const float toward_south = wind_south * arguments.per_speed_s_m;
  const float per_speed_s_m = arguments.per_speed_s_m;
  const float half_bends_per_m_s = arguments.half_bends_per_m_s;
  const float max_bend_rad = arguments.max_bend_rad;
  const float stroke_rad = arguments.stroke_rad;
  const float sheltered = arguments.sheltered;
  for (std::size_t i = 0; i < arguments.count; ++i) {
    // The wind along the skin.
    const float outward = wind_east * normal_x[i] + wind_south * normal_z[i];
    const float left = wind_square - outward * outward;
    const float square = left > 0.0F ? left : 0.0F;
    const float per_m_s = half_bends_per_m_s * flexibility[i];
    const float s_square = per_m_s * per_m_s * square;
    const float share = bend_share(s_square);

    const float lee = outward * per_speed_s_m;
    const float exposure = 1.0F - sheltered * (lee > 0.0F ? lee : 0.0F);
    const float along = share * (max_bend_rad * exposure + stroke_rad * stroke_along[i]);
    const float across = share * stroke_rad * stroke_across[i];
    out_east[i] = along * toward_east - across * toward_south;
    out_south[i] = along * toward_south + across * toward_east;
  }
}

}  // namespace

const BendingKernels YURAGI_ROW_NAME(bending_kernels) = {bend, bend_locally, bend_coat};

}  // namespace yuragi::operators
