#pragma once

#include <optional>

namespace yuragi::daemon::feeds {

/// What comes round at an interval. A late call does not move the ones after it.
class Interval {
 public:
  explicit Interval(double every_s) : every_s_(every_s) {}
  bool is_due(double now_s) {
    constexpr double kEarly_s = 1e-6;  // of times that are sums of many steps
    if (next_s_ && now_s + kEarly_s < *next_s_) return false;
    next_s_ = next_s_ && now_s - *next_s_ < every_s_ ? *next_s_ + every_s_ : now_s + every_s_;
    return true;
  }

 private:
  double every_s_;
  std::optional<double> next_s_;
};

}  // namespace yuragi::daemon::feeds
