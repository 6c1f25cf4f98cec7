#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>

#include "daemon/animation/duration_histogram.hpp"
#include "daemon/animation/recent_window.hpp"

namespace yuragi::daemon::animation {

/// How late the steps of the last 10 minutes were (RecentWindow), of a histogram that counts all. Belongs to one reader
/// of the histogram. Thread-safe: no.
class RecentLateness {
 public:
  explicit RecentLateness(const DurationHistogram& all) : all_(&all) {}

  /// Takes what was counted until `now`; call it at least once a minute.
  void advance(MonoTime now) noexcept {
    recent_ = all_->counts();
    const DurationHistogram::Counts& before = before_.begin_at(now, recent_);
    std::transform(recent_.begin(), recent_.end(), before.begin(), recent_.begin(), std::minus<>());
  }

  std::uint64_t count() const noexcept { return std::accumulate(recent_.begin(), recent_.end(), std::uint64_t{0}); }
  double percentile_s(double share) const noexcept { return DurationHistogram::percentile_s(recent_, share); }
  /// At most an eighth too large.
  double max_s() const noexcept { return std::min(percentile_s(1.0), all_->max_s()); }

 private:
  const DurationHistogram* all_;
  RecentWindow<DurationHistogram::Counts> before_;
  DurationHistogram::Counts recent_{};
};

}  // namespace yuragi::daemon::animation
