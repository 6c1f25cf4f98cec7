#include "daemon/tools/report/gust_means.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::daemon::tools::report {
namespace {

constexpr double kGust_s = 3.0;
/// The most readings in 3 s; a sensor that sends more has no gust.
constexpr std::size_t kMaxPast = 1000;
/// A block counts when it has so much of its readings, and is not calm.
constexpr double kWholeBlock = 0.95;
constexpr double kMinMean_m_s = 1.0;

}  // namespace

std::optional<double> ThreeSecondMean::add(Nanoseconds time, double speed_m_s) {
  if (!(interval_s_ > 0.0) || interval_s_ > kMaxInterval_s) return std::nullopt;
  past_.push_back({time, speed_m_s});
  while (past_.front().time <= time - from_seconds(kGust_s) || past_.size() > kMaxPast) past_.pop_front();
  const auto count = static_cast<double>(past_.size());
  if ((count + 0.5) * interval_s_ < kGust_s) return std::nullopt;
  double sum = 0.0;
  for (const Past& past : past_) sum += past.speed_m_s;
  return sum / count;
}

void TenMinuteBlocks::add(double time_s, double speed_m_s, const std::optional<double>& three_second_mean_m_s) {
  const double index = std::floor(time_s / kBlock_s);
  if (index != index_) {
    close();
    index_ = index;
  }
  ++count_;
  const double distance = speed_m_s - mean_m_s_;
  mean_m_s_ += distance / static_cast<double>(count_);
  squares_m2_s2_ += distance * (speed_m_s - mean_m_s_);
  gust_m_s_ = std::max(gust_m_s_, three_second_mean_m_s.value_or(0.0));
}

void TenMinuteBlocks::close() {
  const auto count = static_cast<double>(count_);
  if (count * interval_s_ >= kWholeBlock * kBlock_s && mean_m_s_ >= kMinMean_m_s) {
    ++blocks_;
    intensity_sum_ += std::sqrt(squares_m2_s2_ / count) / mean_m_s_;
    if (gust_m_s_ > 0.0) {
      ++gusty_blocks_;
      factor_sum_ += gust_m_s_ / mean_m_s_;
    }
  }
  count_ = 0;
  mean_m_s_ = squares_m2_s2_ = gust_m_s_ = 0.0;
}

BlockNumbers TenMinuteBlocks::finish() {
  close();
  BlockNumbers numbers;
  numbers.blocks = blocks_;
  if (blocks_ > 0) numbers.turbulence_intensity = intensity_sum_ / static_cast<double>(blocks_);
  if (gusty_blocks_ > 0) numbers.gust_factor = factor_sum_ / static_cast<double>(gusty_blocks_);
  return numbers;
}

}  // namespace yuragi::daemon::tools::report
