#include "engine/operators/propagation_history.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace yuragi::operators {

PropagationHistory::PropagationHistory(std::size_t width, double longest_s)
    : width_(width),
      count_(static_cast<std::size_t>(std::ceil(longest_s * kSampleRate_hz)) + 2),
      samples_(count_ * width, 0.0F),
      present_(width, 0.0F) {}

void PropagationHistory::push(std::span<const float> values, double dt_s) noexcept {
  if (!(dt_s > 0.0) || values.size() != width_) return;

  // Samples between the previous present and the new one. After a pause longer than the ring, those that would be
  // overwritten at once are skipped.
  const double step = dt_s * kSampleRate_hz;
  const double due = std::floor(phase_ + step);
  const double first = std::max(1.0, due - static_cast<double>(count_) + 1.0);
  for (std::int64_t ahead = 0; first + static_cast<double>(ahead) <= due; ++ahead) {
    const double number = first + static_cast<double>(ahead);
    const auto part = static_cast<float>(std::clamp((number - phase_) / step, 0.0, 1.0));
    latest_ = (latest_ + count_ - 1) % count_;
    float* const row = samples_.data() + sample(0);
    for (std::size_t i = 0; i < width_; ++i) row[i] = present_[i] + part * (values[i] - present_[i]);
  }
  phase_ = phase_ + step - due;
  std::copy(values.begin(), values.end(), present_.begin());
}

PropagationHistory::Between PropagationHistory::at(double delay_s) const noexcept {
  const double delay = std::max(delay_s, 0.0) * kSampleRate_hz;
  const float* const samples = samples_.data();
  if (delay < phase_) return {present_.data(), samples + sample(0), static_cast<float>(delay / phase_)};
  const double age = std::min(delay - phase_, static_cast<double>(count_ - 2));
  const auto newer = std::min(static_cast<std::size_t>(age), count_ - 2);
  return {samples + sample(newer), samples + sample(newer + 1), static_cast<float>(age - static_cast<double>(newer))};
}

}  // namespace yuragi::operators
