#include "engine/wind/blend/relative_scale.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::wind::blend {
namespace {

constexpr double kMinScale = 0.05;
constexpr double kMaxScale = 20.0;
/// The gain of the mean has full weight after a multiple of this time.
constexpr double kTimeToBelieve_s = 15.0;
/// And that of the gusts after a multiple of this number of independent gusts.
constexpr double kGustsToBelieve = 4.0;
/// Added to both sides of a ratio: with hardly any wind it is 1.
constexpr double kMinSum = 1e-3;

double log_ratio(double above, double below) noexcept {
  return std::clamp(std::log((above + kMinSum) / (below + kMinSum)), std::log(kMinScale), std::log(kMaxScale));
}

}  // namespace

void RelativeScale::learn(const Pair& pair, double dt_s) noexcept {
  if (!(dt_s > 0.0)) return;
  const double kept = std::exp(-dt_s / memory_s_);
  const double added_s = memory_s_ * (1.0 - kept);
  weight_s_ = kept * weight_s_ + added_s;
  speed_ = kept * speed_ + added_s * pair.speed_m_s;
  relative_speed_ = kept * relative_speed_ + added_s * pair.relative_speed_m_s;
  square_ = kept * square_ + added_s * pair.gust_m_s * pair.gust_m_s;
  relative_square_ = kept * relative_square_ + added_s * pair.relative_gust_m_s * pair.relative_gust_m_s;
  gusts_seen_ = kept * gusts_seen_ + added_s / pair.independent_after_s;

  const double log_mean = weight_s_ / (weight_s_ + kTimeToBelieve_s) * log_ratio(speed_, relative_speed_);
  const double belief = gusts_seen_ / (gusts_seen_ + kGustsToBelieve);
  const double log_gust = log_mean + belief * (log_ratio(std::sqrt(square_), std::sqrt(relative_square_)) - log_mean);
  mean_gain_ = std::exp(log_mean);
  gust_gain_ = std::exp(log_gust);
}

}  // namespace yuragi::wind::blend
