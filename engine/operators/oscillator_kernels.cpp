#include "engine/base/kernel.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi::operators {
namespace {

/// An oscillator with smaller values is at rest. (Further decay would lead to denormal numbers, which are slow.)
constexpr float kAtRest = 1e-9F;

/// Advances one oscillator by a tick.
[[gnu::always_inline]] inline void go_on(float q_from_e, float q_from_v, float v_from_e, float v_from_v, float blend,
                                         float& value, float& rate, float& driven) noexcept {
  const float g = driven;
  const float e = value - g;
  const float q = g + (q_from_e * e + q_from_v * rate);
  const float v = v_from_e * e + v_from_v * rate;
  const float size = __builtin_fabsf(q) + __builtin_fabsf(v);
  const float settled = size < kAtRest ? 0.0F : q;
  value = settled;
  rate = size < kAtRest ? 0.0F : v;
  driven = g + blend * (settled - g);
}

void step(const OscillatorKernelArguments& arguments) noexcept {
  const OscillatorKernelArguments in = arguments;  // a copy, which stores to the outputs cannot change
  float* const __restrict value = in.value;
  float* const __restrict rate = in.rate;
  float* const __restrict driven = in.driven;
  for (std::size_t i = 0; i < in.count; ++i) {
    go_on(in.q_from_e, in.q_from_v, in.v_from_e, in.v_from_v, in.blend, value[i], rate[i], driven[i]);
  }
}

void step_each(const OscillatorKernelArguments& arguments) noexcept {
  const OscillatorKernelArguments in = arguments;
  float* const __restrict value = in.value;
  float* const __restrict rate = in.rate;
  float* const __restrict driven = in.driven;
  for (std::size_t i = 0; i < in.count; ++i) {
    go_on(in.each_q_from_e[i], in.each_q_from_v[i], in.each_v_from_e[i], in.each_v_from_v[i], in.blend, value[i],
          rate[i], driven[i]);
  }
}

}  // namespace

const OscillatorKernels YURAGI_ROW_NAME(oscillator_kernels) = {step, step_each};

}  // namespace yuragi::operators
