#include "engine/base/kernel.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi {
namespace {

/// What has died away this far is at rest. (Decaying on, it would come to numbers that processors are slow with.)
constexpr float kAtRest = 1e-9F;

void step(const OscillatorKernelArguments& arguments) noexcept {
  const OscillatorKernelArguments in = arguments;  // a copy, which no store to the outputs can be taken for a change of
  float* const __restrict value = in.value;
  float* const __restrict rate = in.rate;
  float* const __restrict driven = in.driven;
  for (std::size_t i = 0; i < in.count; ++i) {
    const float g = driven[i];
    const float e = value[i] - g;
    const float q = g + (in.q_from_e * e + in.q_from_v * rate[i]);
    const float v = in.v_from_e * e + in.v_from_v * rate[i];
    const float size = __builtin_fabsf(q) + __builtin_fabsf(v);
    const float settled = size < kAtRest ? 0.0F : q;
    value[i] = settled;
    rate[i] = size < kAtRest ? 0.0F : v;
    driven[i] = g + in.blend * (settled - g);
  }
}

}  // namespace

const OscillatorKernels YURAGI_ROW_NAME(oscillator_kernels) = {step};

}  // namespace yuragi
