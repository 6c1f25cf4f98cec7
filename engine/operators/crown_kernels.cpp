#include "engine/operators/crown_kernels.hpp"

#include "engine/base/kernel.hpp"
#include "engine/operators/bend_share.hpp"
#include "engine/operators/streamlined_drag.hpp"

namespace yuragi::operators {
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
  const SplitKernelArguments in = arguments;  // a copy, which stores cannot change
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

void force(const ForceKernelArguments& arguments) noexcept {
  const ForceKernelArguments in = arguments;
  float* const __restrict noise = in.noise;
  float* const __restrict toward_east = in.toward_east;
  float* const __restrict toward_south = in.toward_south;
  for (std::size_t i = 0; i < in.count; ++i) {
    const float east = in.wind_east_m_s[i];
    const float south = in.wind_south_m_s[i];
    const float square = east * east + south * south;
    const float speed_square = square * (in.per_streamline_speed * in.per_streamline_speed);
    noise[i] = streamlined_drag(speed_square) * in.per_mean_force - 1.0F;
    const float per_length = 1.0F / __builtin_sqrtf(square + in.calm_square);
    toward_east[i] = east * per_length;
    toward_south[i] = south * per_length;
  }
}

/// x if it is small, and never beyond `limit`. (For x = 0 and limit = 0 it is 0.)
[[gnu::always_inline]] inline float capped(float x, float limit) noexcept {
  return x * (limit / __builtin_sqrtf(limit * limit + x * x + 1e-30F));
}

void tilt(const TiltKernelArguments& arguments) noexcept {
  const TiltKernelArguments in = arguments;
  float* const __restrict out_east = in.out_east_rad;
  float* const __restrict out_south = in.out_south_rad;
  for (std::size_t i = 0; i < in.count; ++i) {
    const float reach = in.force * in.gain[i] / in.distance[i];
    const float along = capped(reach * (in.vertical[i] + in.alpha_vertical), in.max_tilt_rad);
    const float across = capped(reach * (in.horizontal[i] + in.beta_horizontal), in.max_swing_rad);
    const float east = in.toward_east[i];
    const float south = in.toward_south[i];
    out_east[i] = east * along - south * across;
    out_south[i] = south * along + east * across;
  }
}

void respond(const LeafKernelArguments& arguments) noexcept {
  const LeafKernelArguments in = arguments;
  float* const __restrict lean_east = in.out_lean_east_rad;
  float* const __restrict lean_south = in.out_lean_south_rad;
  float* const __restrict flutter = in.out_flutter_rad;
  for (std::size_t i = 0; i < in.count; ++i) {
    const float east = in.wind_east_m_s[i];
    const float south = in.wind_south_m_s[i];
    const float square = east * east + south * south;
    const float s_square = square * (in.per_half_lean_speed * in.per_half_lean_speed);
    const float lean = in.lean_rad * in.per_half_lean_speed * bend_share_over_s(__builtin_sqrtf(s_square), s_square);
    lean_east[i] = lean * east;
    lean_south[i] = lean * south;
    const float base = 1.0F + in.eighth_per_flutter_square * square;
    const float power_2 = base * base;
    const float power_4 = power_2 * power_2;
    flutter[i] = in.flutter_rad * (1.0F - 1.0F / (power_4 * power_4));
  }
}

void flutter(const FlutterKernelArguments& arguments) noexcept {
  const FlutterKernelArguments in = arguments;
  float* const __restrict out_east = in.out_east_rad;
  float* const __restrict out_south = in.out_south_rad;
  for (std::size_t spray = 0; spray < in.sprays; ++spray) {
    const std::uint32_t place = in.place[spray];
    const float lean_east = in.lean_east_rad[place];
    const float lean_south = in.lean_south_rad[place];
    const float flutter = in.flutter_rad[place];
    for (std::size_t i = 16 * spray; i < 16 * spray + 16; ++i) {
      const float to_and_fro = flutter * in.noise[i];
      out_east[i] = in.give[i] * lean_east + to_and_fro * in.axis_east[i];
      out_south[i] = in.give[i] * lean_south + to_and_fro * in.axis_south[i];
    }
  }
}

}  // namespace

const CrownKernels YURAGI_ROW_NAME(crown_kernels) = {split, force, tilt, respond, flutter};

}  // namespace yuragi::operators
