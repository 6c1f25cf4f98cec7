#include "engine/operators/surface_kernels.hpp"

#include <cstddef>

#include "engine/base/kernel.hpp"

namespace yuragi::operators {
namespace {

// Outputs may be inputs, element by element, so nothing is declared __restrict.

[[gnu::always_inline]] inline float from_0_to_1(float value) noexcept {
  const float positive = value > 0.0F ? value : 0.0F;  // what is no number is 0
  return positive < 1.0F ? positive : 1.0F;
}

void threshold_ramp(const ThresholdRampArguments& arguments) noexcept {
  const ThresholdRampArguments in = arguments;  // a copy, which no store can be taken for a change of
  for (std::size_t i = 0; i < in.count; ++i) {
    const float threshold = in.first_threshold + in.rise * in.along[i];
    const float t = from_0_to_1((in.noise[i] - threshold) * in.per_edge);
    in.out[i] = t * t * (3.0F - 2.0F * t);
  }
}

void displace(const DisplacementArguments& arguments) noexcept {
  const DisplacementArguments in = arguments;
  // + 0: what does not move is at 0, and not at -0, for poses are compared bit for bit.
  for (std::size_t i = 0; i < in.count; ++i) in.out[i] = in.amplitude_m * in.share[i] * in.noise[i] + 0.0F;
}

}  // namespace

const SurfaceKernels YURAGI_ROW_NAME(surface_kernels) = {threshold_ramp, displace};

}  // namespace yuragi::operators
