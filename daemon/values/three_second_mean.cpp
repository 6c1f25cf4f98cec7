#include "daemon/values/three_second_mean.hpp"

namespace yuragi::daemon::values {
namespace {

constexpr double kPart_s = 0.25;

}  // namespace

std::optional<double> ThreeSecondMean::add(double value, double dt_s) noexcept {
  parts_[part_].add(value, dt_s);
  since_part_s_ += dt_s;
  if (since_part_s_ < kPart_s) return std::nullopt;
  const double over = mean();
  while (since_part_s_ >= kPart_s) {
    since_part_s_ -= kPart_s;
    part_ = (part_ + 1) % kParts;
    parts_[part_] = {};
  }
  return over;
}

double ThreeSecondMean::mean() const noexcept {
  TimeSum all;
  for (const TimeSum& part : parts_) {
    all.value += part.value;
    all.time_s += part.time_s;
  }
  return all.mean();
}

}  // namespace yuragi::daemon::values
