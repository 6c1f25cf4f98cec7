#include "engine/wind/blend/reading_interval.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace yuragi::wind::blend {
namespace {

/// The median is over this many gaps.
constexpr std::size_t kMedianOf = 9;
/// A gap shorter than this part of the usual pause is within a burst.
constexpr double kBurstPart = 0.25;
/// The station sends in bursts if at least one of this many gaps is within a burst.
constexpr std::size_t kGapsPerBurstGap = 4;
/// Twelve gaps hold two pauses of bursts of five.
constexpr std::size_t kSettledAfter = 12;

/// Half of the time, without the longest gap, is spent in gaps up to the returned one; the only gap if there is one.
/// Sorts the gaps, of which there is at least one.
double usual_pause_s(std::span<double> gaps_s) noexcept {
  std::ranges::sort(gaps_s);
  if (gaps_s.size() == 1) return gaps_s[0];
  const std::span<const double> counted = gaps_s.first(gaps_s.size() - 1);
  const double half_s = 0.5 * std::accumulate(counted.begin(), counted.end(), 0.0);
  double sum_s = 0.0;
  for (const double gap_s : counted) {
    sum_s += gap_s;
    if (sum_s >= half_s) return gap_s;
  }
  return counted.back();
}

}  // namespace

bool ReadingInterval::take(double gap_s, bool is_same) noexcept {
  if (speaks_ == Speaks::kOnChange) return take_change(gap_s, is_same);
  if (!(gap_s > 0.0)) return !is_same && !is_in_bursts_;

  gaps_s_[seen_++ % kKept] = gap_s;
  if (!is_same && !(soonest_change_s_ > 0.0 && soonest_change_s_ <= gap_s)) soonest_change_s_ = gap_s;
  measure();

  since_new_s_ += gap_s;
  const bool is_new = !is_in_bursts_ || since_new_s_ >= kBurstPart * interval_s_;
  if (is_new) since_new_s_ = 0.0;
  return is_new;
}

bool ReadingInterval::take_change(double gap_s, bool is_same) noexcept {
  is_settled_ = true;
  since_new_s_ += gap_s;
  if (is_same) return false;
  if (since_new_s_ > 0.0) {
    gaps_s_[seen_++ % kKept] = since_new_s_;
    interval_s_ = median_s();
  }
  since_new_s_ = 0.0;
  return true;
}

/// Over the last nine gaps.
double ReadingInterval::median_s() const noexcept {
  std::array<double, kMedianOf> last_s{};
  const std::size_t known = std::min(seen_, kMedianOf);
  for (std::size_t i = 0; i < known; ++i) last_s[i] = gaps_s_[(seen_ - 1 - i) % kKept];
  const auto middle = last_s.begin() + static_cast<std::ptrdiff_t>(known / 2);
  std::nth_element(last_s.begin(), middle, last_s.begin() + static_cast<std::ptrdiff_t>(known));
  return *middle;
}

void ReadingInterval::measure() noexcept {
  const std::size_t known = count();
  std::array<double, kKept> scratch_s = gaps_s_;
  const std::span<double> sorted_s(scratch_s.data(), known);
  const double shortest_pause_s = kBurstPart * usual_pause_s(sorted_s);
  const auto in_bursts =
      static_cast<std::size_t>(std::ranges::lower_bound(sorted_s, shortest_pause_s) - sorted_s.begin());
  is_in_bursts_ = in_bursts > 0 && kGapsPerBurstGap * in_bursts >= known;
  interval_s_ = median_s();
  is_settled_ = known >= kSettledAfter || (soonest_change_s_ > 0.0 && kBurstPart * soonest_change_s_ <= interval_s_);
  if (!is_in_bursts_) return;

  // From burst to burst.
  std::size_t bursts = 0;
  double since_s = 0.0;
  for (std::size_t i = 0; i < known; ++i) {
    since_s += gaps_s_[(seen_ - known + i) % kKept];
    if (since_s < shortest_pause_s) continue;
    scratch_s[bursts++] = since_s;
    since_s = 0.0;
  }
  interval_s_ = usual_pause_s(std::span(scratch_s.data(), bursts));
}

}  // namespace yuragi::wind::blend
