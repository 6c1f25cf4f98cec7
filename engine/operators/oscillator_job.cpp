#include "engine/operators/oscillator_job.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/base/units.hpp"
#include "engine/operators/operator_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<OscillatorKernels> kOscillatorRows = YURAGI_KERNEL_ROWS(oscillator_kernels);

}  // namespace

OscillatorStep OscillatorStep::exact(double natural_hz, double damping_ratio, double dt_s) noexcept {
  const double w = 2.0 * kPi * natural_hz;
  const double damped_w = w * std::sqrt(1.0 - damping_ratio * damping_ratio);
  const double decay = std::exp(-damping_ratio * w * dt_s);
  const double c = std::cos(damped_w * dt_s);
  const double s = std::sin(damped_w * dt_s);
  const double lag = damping_ratio * w / damped_w * s;
  return {.q_from_e = decay * (c + lag),
          .q_from_v = decay * s / damped_w,
          .v_from_e = -decay * w * w / damped_w * s,
          .v_from_v = decay * (c - lag)};
}

double OscillatorStep::largest_gain(double damping_ratio) noexcept {
  return 1.0 / std::tanh(kPi * damping_ratio / (2.0 * std::sqrt(1.0 - damping_ratio * damping_ratio)));
}

double OscillatorStep::largest_rate_per_s(double natural_hz, double damping_ratio) noexcept {
  const double w = 2.0 * kPi * natural_hz;
  const double root = std::sqrt(1.0 - damping_ratio * damping_ratio);
  const double first_peak_s = std::atan2(root, damping_ratio) / (w * root);
  const double first_peak = w * std::exp(-damping_ratio * w * first_peak_s);
  return 2.0 * first_peak / (1.0 - std::exp(-kPi * damping_ratio / root));
}

void OscillatorSteps::set(std::size_t i, const OscillatorStep& step) noexcept {
  q_from_e[i] = static_cast<float>(step.q_from_e);
  q_from_v[i] = static_cast<float>(step.q_from_v);
  v_from_e[i] = static_cast<float>(step.v_from_e);
  v_from_v[i] = static_cast<float>(step.v_from_v);
}

void OscillatorSteps::set_pace(std::span<const float> natural_hz, double damping_ratio, double dt_s) noexcept {
  if (dt_s == dt_s_) return;
  dt_s_ = dt_s;
  for (std::size_t i = 0; i < natural_hz.size(); ++i) {
    set(i, OscillatorStep::exact(static_cast<double>(natural_hz[i]), damping_ratio, dt_s));
  }
}

OscillatorJob::Problem OscillatorJob::validate() const noexcept {
  if (oscillators == nullptr) return Problem::kNoOscillators;
  if (!std::isfinite(step.q_from_e + step.q_from_v + step.v_from_e + step.v_from_v)) return Problem::kStepNotFinite;
  if (!(blend >= 0.0 && blend <= 1.0)) return Problem::kBlend;
  const std::size_t count = east.size();
  if (south.size() != count) return Problem::kSizesDiffer;
  const auto has_room = [this, count](const std::vector<float>& array) {
    return array.size() >= first && array.size() - first >= count;
  };
  for (const auto* array :
       {&oscillators->value_east, &oscillators->rate_east, &oscillators->value_south, &oscillators->rate_south}) {
    if (!has_room(*array)) return Problem::kSizesDiffer;
  }
  if (steps != nullptr) {
    for (const auto* array : {&steps->q_from_e, &steps->q_from_v, &steps->v_from_e, &steps->v_from_v}) {
      if (!has_room(*array)) return Problem::kSizesDiffer;
    }
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

OscillatorJob::Problem OscillatorJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone || blend == 0.0) return problem;

  const OscillatorKernels& kernels = kOscillatorRows[row.value_or(best_simd_row())];
  auto* const go_on = steps != nullptr ? kernels.step_each : kernels.step;
  // So many at a time that the steps, which both axes read, are still in the nearest cache for the second.
  constexpr std::size_t kAtOnce = 1024;
  for (std::size_t begin = 0; begin < east.size(); begin += kAtOnce) {
    const std::size_t i = first + begin;
    OscillatorKernelArguments arguments{.count = std::min(kAtOnce, east.size() - begin),
                                        .q_from_e = static_cast<float>(step.q_from_e),
                                        .q_from_v = static_cast<float>(step.q_from_v),
                                        .v_from_e = static_cast<float>(step.v_from_e),
                                        .v_from_v = static_cast<float>(step.v_from_v),
                                        .blend = static_cast<float>(blend),
                                        .value = oscillators->value_east.data() + i,
                                        .rate = oscillators->rate_east.data() + i,
                                        .driven = east.data() + begin};
    if (steps != nullptr) {
      arguments.each_q_from_e = steps->q_from_e.data() + i;
      arguments.each_q_from_v = steps->q_from_v.data() + i;
      arguments.each_v_from_e = steps->v_from_e.data() + i;
      arguments.each_v_from_v = steps->v_from_v.data() + i;
    }
    go_on(arguments);
    arguments.value = oscillators->value_south.data() + i;
    arguments.rate = oscillators->rate_south.data() + i;
    arguments.driven = south.data() + begin;
    go_on(arguments);
  }
  return Problem::kNone;
}

}  // namespace yuragi::operators
