#include "engine/operators/crown_kernels.hpp"

#include "engine/base/kernel.hpp"

namespace yuragi {
namespace {

/// The ramp whose slope is the smooth step 3 u^2 - 2 u^3 over `width` around 0: 0 below, x above.
[[gnu::always_inline]] inline float smooth_ramp(float x, float width, float per_width) noexcept {
  const float along = x * per_width + 0.5F;
  const float low = along > 0.0F ? along : 0.0F;
  const float u = low < 1.0F ? low : 1.0F;
  const float beyond = x - 0.5F * width;
  return width * (u * u * u * (1.0F - 0.5F * u)) + (beyond > 0.0F ? beyond : 0.0F);
}

void split(const SplitKernelArguments& arguments) noexcept {
  const SplitKernelArguments in = arguments;  // a copy, which no store can be taken for a change of
  float* const __restrict above = in.above;
  float* const __restrict below = in.below;
  const float per_width = 1.0F / in.width;
  for (std::size_t i = 0; i < in.count; ++i) {
    const float threshold = in.threshold + in.threshold_rise * in.ramp[i];
    const float part =
        smooth_ramp(in.noise[i] - threshold, in.width, per_width) - smooth_ramp(-threshold, in.width, per_width);
    above[i] = part;
    below[i] = in.noise[i] - part;
  }
}

/// x where it is small, and never beyond 1.
[[gnu::always_inline]] inline float saturated(float x) noexcept {
  return x / __builtin_sqrtf(1.0F + x * x);
}

void tilt(const TiltKernelArguments& arguments) noexcept {
  const TiltKernelArguments in = arguments;
  float* const __restrict east = in.out_east_rad;
  float* const __restrict south = in.out_south_rad;
  for (std::size_t i = 0; i < in.count; ++i) {
    const float wind = in.gain[i] * in.response / in.distance[i];
    const float along = in.max_tilt_rad * saturated(wind * (in.vertical[i] + in.alpha_vertical));
    const float across = in.max_swing_rad * saturated(wind * (in.horizontal[i] + in.beta_horizontal));
    east[i] = in.toward_east * along - in.toward_south * across;
    south[i] = in.toward_south * along + in.toward_east * across;
  }
}

void flutter(const FlutterKernelArguments& arguments) noexcept {
  const FlutterKernelArguments in = arguments;
  float* const __restrict east = in.out_east_rad;
  float* const __restrict south = in.out_south_rad;
  for (std::size_t i = 0; i < in.count; ++i) {
    const float bend = in.lean_rad + in.flutter_rad * in.noise[i];
    east[i] = bend * (in.toward_east * in.along[i] - in.toward_south * in.across[i]);
    south[i] = bend * (in.toward_south * in.along[i] + in.toward_east * in.across[i]);
  }
}

}  // namespace

const CrownKernels YURAGI_ROW_NAME(crown_kernels) = {split, tilt, flutter};

}  // namespace yuragi
