#include "engine/operators/surface_kernels.hpp"

#include <cstddef>

#include "engine/base/kernel.hpp"

namespace yuragi::operators {
namespace {

// Outputs can be inputs, element by element, so nothing is declared __restrict.

[[gnu::always_inline]] inline float from_0_to_1(float value) noexcept {
  const float positive = value > 0.0F ? value : 0.0F;  // NaN becomes 0
  return positive < 1.0F ? positive : 1.0F;
}

void threshold_ramp(const ThresholdRampArguments& arguments) noexcept {
  const ThresholdRampArguments in = arguments;  // a copy, which stores cannot change
  for (std::size_t i = 0; i < in.count; ++i) {
    const float threshold = in.first_threshold + in.rise * in.along[i];
    const float t = from_0_to_1((in.noise[i] - threshold) * in.per_edge);
    in.out[i] = t * t * (3.0F - 2.0F * t);
  }
}

void displace(const DisplacementArguments& arguments) noexcept {
  const DisplacementArguments in = arguments;
  // + 0: unmoved points are at 0, not at -0, because poses are compared bit for bit.
  for (std::size_t i = 0; i < in.count; ++i) in.out[i] = in.amplitude_m * in.share[i] * in.noise[i] + 0.0F;
}

}  // namespace

const SurfaceKernels YURAGI_ROW_NAME(surface_kernels) = {threshold_ramp, displace};

}  // namespace yuragi::operators
