#include "engine/wind/turbulence/wind_turbulence.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::wind::turbulence {
namespace {

constexpr double kMaxDifference = 1.0;
/// A smaller one is rounding of the sums: a constant wind has no turbulence.
constexpr double kMinDifference = 1e-9;

/// Of the longest means, with as many readings before.
constexpr std::size_t kMaxHistory = std::size_t{2} << (Fit::kScales - 1);
/// Of the ring of sums: with room for the sum before the longest history.
constexpr std::size_t kRingSize = 2 * kMaxHistory;

Prior across_the_wind(Prior prior) {
  prior.intensity *= kAcrossPerAlong;
  return prior;
}

}  // namespace

WindTurbulence::WindTurbulence(const Prior& prior, double memory_s, ReadingValue value)
    : along_(prior, memory_s, value),
      across_(across_the_wind(prior), memory_s, value, WindComponent::kAcross),
      sums_(kRingSize) {
  if (value == ReadingValue::kUnknown) verdict_.emplace(prior.length_m);
}

void WindTurbulence::forget(double dt_s) noexcept {
  along_.forget(dt_s);
  across_.forget(dt_s);
  if (verdict_) verdict_->forget(dt_s);
}

/// From now on sums start at the last reading.
void WindTurbulence::begin_turn() noexcept {
  const Vector total = sums_[last_];
  for (Vector& sum : sums_) sum = sum - total;
}

void WindTurbulence::take(Vector wind, Vector ahead, double speed_m_s, bool has_across) noexcept {
  if (last_ == kRingSize - 1) begin_turn();
  const Vector before = sums_[last_];
  last_ = (last_ + 1) % kRingSize;
  sums_[last_] = before + wind;
  history_size_ = std::min(history_size_ + 1, kMaxHistory);

  const auto sum_until = [&](std::size_t back) { return sums_[(last_ + kRingSize - back) % kRingSize]; };
  const auto limited = [](double part) {
    return std::abs(part) < kMinDifference ? 0.0 : std::clamp(part, -kMaxDifference, kMaxDifference);
  };
  for (std::size_t scale = 0; scale < Fit::kScales; ++scale) {
    const std::size_t count = std::size_t{1} << scale;
    if (history_size_ < 2 * count) return;
    const Vector middle = sum_until(count);
    const Vector newer = sum_until(0) - middle;
    const Vector older = middle - sum_until(2 * count);
    const Vector difference = 1.0 / (static_cast<double>(count) * speed_m_s) * (newer - older);
    const double along = limited(difference.u_m_s * ahead.u_m_s + difference.v_m_s * ahead.v_m_s);
    along_.add(scale, along, speed_m_s);
    if (verdict_) verdict_->add(scale, along, speed_m_s);
    if (!has_across) continue;
    across_.add(scale, limited(difference.v_m_s * ahead.u_m_s - difference.u_m_s * ahead.v_m_s), speed_m_s);
  }
}

void WindTurbulence::fit(double interval_s, double speed_m_s) noexcept {
  along_.fit(interval_s, speed_m_s);
  across_.fit(interval_s, speed_m_s);
  if (verdict_) verdict_->judge(interval_s, speed_m_s);
}

}  // namespace yuragi::wind::turbulence
