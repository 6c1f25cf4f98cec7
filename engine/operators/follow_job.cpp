#include "engine/operators/follow_job.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi {
namespace {

/// Of value and rate: below it nothing is seen to move, and the rest of the way would be in numbers that processors are
/// slow with.
constexpr float kAtRest = 1e-9F;

/// In w dt: nothing is left of any distance.
constexpr double kLongAgo = 80.0;

}  // namespace

FollowJob::Problem FollowJob::validate() const noexcept {
  if (!std::isfinite(omega_rad_s) || !(omega_rad_s > 0.0)) return Problem::kOmega;
  if (!std::isfinite(dt_s) || !(dt_s > 0.0)) return Problem::kStepNotPositive;
  if (value.size() != target.size() || rate_per_s.size() != target.size()) return Problem::kSizesDiffer;
  return Problem::kNone;
}

FollowJob::Problem FollowJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;

  // With d = q - target: d(t) = (d + (q' + w d) t) exp(-w t), and its derivative.
  const double phase = std::min(omega_rad_s * dt_s, kLongAgo);
  const double step_s = phase / omega_rad_s;
  const double decay = std::exp(-phase);
  const auto distance_kept = static_cast<float>(decay * (1.0 + phase));
  const auto distance_from_rate_s = static_cast<float>(decay * step_s);
  const auto rate_kept = static_cast<float>(decay * (1.0 - phase));
  const auto rate_from_distance_per_s = static_cast<float>(decay * omega_rad_s * phase);
  for (std::size_t i = 0; i < target.size(); ++i) {
    const float distance = value[i] - target[i];
    const float rate = rate_per_s[i];
    const float new_value = target[i] + (distance_kept * distance + distance_from_rate_s * rate);
    const float new_rate = rate_kept * rate - rate_from_distance_per_s * distance;
    const bool at_rest = std::abs(new_value) < kAtRest && std::abs(new_rate) < kAtRest;
    value[i] = at_rest ? 0.0F : new_value;
    rate_per_s[i] = at_rest ? 0.0F : new_rate;
  }
  return Problem::kNone;
}

}  // namespace yuragi
