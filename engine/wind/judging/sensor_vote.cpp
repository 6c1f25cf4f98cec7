#include "engine/wind/judging/sensor_vote.hpp"

#include <algorithm>

namespace yuragi::wind::judging {
namespace {

constexpr double kCountEvery_s = 1.0;
/// A halt of the machine counts as at most this long.
constexpr double kMaxCount_s = 10.0;

/// A judgement with a memory: it needs the whole patience to change either way.
void weigh(double& sum_s, bool& verdict, double step_s, double patience_s) noexcept {
  sum_s = std::clamp(sum_s + step_s, 0.0, patience_s);
  verdict = verdict ? sum_s > 0.0 : sum_s >= patience_s;
}

}  // namespace

SensorVote::SensorVote(std::size_t sensor_count, const VoteSettings& settings)
    : settings_(settings), voters_(sensor_count) {
  means_m_s_.reserve(sensor_count);
}

void SensorVote::accept(std::size_t sensor, MonoTime time, double speed_m_s) noexcept {
  Voter& voter = voters_[sensor];
  const double passed_s = voter.last ? seconds(time - *voter.last) : 0.0;
  if (passed_s < 0.0) return;
  // The mean of all readings until they span the memory, then an exponential one.
  const bool is_first = !voter.last || passed_s > settings_.memory_s;
  voter.measured_s = is_first ? 0.0 : voter.measured_s + passed_s;
  const double part = is_first ? 1.0 : passed_s / std::max(passed_s, std::min(voter.measured_s, settings_.memory_s));
  if (passed_s > 0.0 || is_first) voter.mean_m_s += part * (speed_m_s - voter.mean_m_s);
  voter.last = time;
}

void SensorVote::forget_mean(std::size_t sensor) noexcept {
  Voter& voter = voters_[sensor];
  voter.last.reset();
  voter.measured_s = 0.0;
}

void SensorVote::advance(MonoTime now) noexcept {
  if (!counted_) counted_ = now;
  const double passed_s = seconds(now - *counted_);
  if (passed_s < kCountEvery_s) return;
  counted_ = now;
  const double step_s = std::min(passed_s, kMaxCount_s);

  const std::optional<double> majority = majority_m_s();
  for (Voter& voter : voters_) {
    const auto differs_from = [&](const Voter& other) {
      return &other != &voter && can_be_compared(other) && !agree(voter.mean_m_s, other.mean_m_s);
    };
    voter.others_m_s.reset();
    const bool has_others =
        std::ranges::any_of(voters_, [&](const Voter& other) { return &other != &voter && can_be_compared(other); });
    if (has_others) voter.others_m_s = median_without(&voter);

    // Without a majority the previous result is kept.
    const bool is_compared = can_be_compared(voter);
    if (majority && is_compared) {
      const double sign = agree(voter.mean_m_s, *majority) ? -1.0 : 1.0;
      weigh(voter.outvoted_s, voter.is_outvoted, sign * step_s, settings_.patience_s);
    }
    const bool is_open = is_compared && !majority && std::ranges::any_of(voters_, differs_from);
    voter.agrees = is_compared && (majority ? agree(voter.mean_m_s, *majority) : !is_open);
    weigh(voter.disputed_s, voter.is_disputed, is_open ? step_s : -step_s, settings_.patience_s);
  }
}

Vote SensorVote::vote_on(std::size_t sensor) const noexcept {
  if (voters_[sensor].is_outvoted) return Vote::kOutvoted;
  return voters_[sensor].is_disputed ? Vote::kDisputed : Vote::kNone;
}

bool SensorVote::can_be_compared(const Voter& voter) const noexcept {
  return voter.is_comparable && voter.measured_s >= settings_.memory_s;
}

bool SensorVote::agree(double a_m_s, double b_m_s) const noexcept {
  return std::max(a_m_s, b_m_s) <= settings_.factor * std::min(a_m_s, b_m_s) + settings_.offset_m_s;
}

/// The median of all, if more than half of at least three agree with it.
std::optional<double> SensorVote::majority_m_s() noexcept {
  const double middle_m_s = median_without(nullptr);
  const auto for_it = std::ranges::count_if(means_m_s_, [&](double mean) { return agree(mean, middle_m_s); });
  if (means_m_s_.size() < 3 || 2 * static_cast<std::size_t>(for_it) <= means_m_s_.size()) return std::nullopt;
  return middle_m_s;
}

/// The (lower) median of the means that can be compared; 0 if there is none.
double SensorVote::median_without(const Voter* left_out) noexcept {
  means_m_s_.clear();
  for (const Voter& voter : voters_) {
    if (&voter != left_out && can_be_compared(voter)) means_m_s_.push_back(voter.mean_m_s);
  }
  if (means_m_s_.empty()) return 0.0;
  const auto middle = means_m_s_.begin() + static_cast<std::ptrdiff_t>((means_m_s_.size() - 1) / 2);
  std::ranges::nth_element(means_m_s_, middle);
  return *middle;
}

}  // namespace yuragi::wind::judging
