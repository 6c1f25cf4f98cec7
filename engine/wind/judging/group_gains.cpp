#include "engine/wind/judging/group_gains.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace yuragi::wind::judging {
namespace {

constexpr double kLearnEvery_s = 1.0;
/// A halt of the machine counts as at most this long.
constexpr double kMaxStep_s = 10.0;
/// Tolerance of a deviation that was written and read.
constexpr double kRounding = 1e-9;

}  // namespace

GroupGains::GroupGains(std::size_t sensor_count, const GroupGainsSettings& settings)
    : settings_(settings), learnt_(sensor_count), gains_(sensor_count, 1.0) {}

void GroupGains::advance(MonoTime now, std::span<const Member> members) noexcept {
  if (!learnt_at_) learnt_at_ = now;
  const double passed_s = seconds(now - *learnt_at_);
  if (passed_s < kLearnEvery_s) return;
  learnt_at_ = now;
  learn(members, std::min(passed_s, kMaxStep_s));
}

void GroupGains::learn(std::span<const Member> members, double step_s) noexcept {
  const std::size_t count = std::min(members.size(), learnt_.size());
  std::size_t in_count = 0;
  double sum_ln = 0.0;
  double least_learnt_s = settings_.memory_s;
  for (std::size_t i = 0; i < count; ++i) {
    if (!members[i].is_in) continue;
    // A sensor without wind has no logarithm; and the others are not in the same wind.
    if (!(members[i].mean_m_s > 0.0)) return;
    ++in_count;
    sum_ln += std::log(members[i].mean_m_s) - learnt_[i].deviation;
    least_learnt_s = std::min(least_learnt_s, learnt_[i].learnt_s);
  }
  if (in_count < 2) return;
  const double wind_ln = sum_ln / static_cast<double>(in_count);
  if (!(wind_ln > std::log(settings_.least_m_s)) || !std::isfinite(wind_ln)) return;

  const double part = std::min(step_s / std::max(settings_.first_s, least_learnt_s), 1.0);
  const auto step_of = [&](std::size_t i) {
    return part * (std::log(members[i].mean_m_s) - learnt_[i].deviation - wind_ln);
  };
  // The steps add up to 0. If one would pass the bound all are shortened, so that they still do.
  double shortened = 1.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!members[i].is_in) continue;
    const double step = step_of(i);
    const double room = std::max(most() - std::copysign(1.0, step) * learnt_[i].deviation, 0.0);
    if (std::abs(step) > room) shortened = std::min(shortened, room / std::abs(step));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!members[i].is_in) continue;
    learnt_[i].deviation += shortened * step_of(i);
    learnt_[i].learnt_s = std::min(learnt_[i].learnt_s + step_s, settings_.memory_s);
  }
  renew_gains();
}

double GroupGains::reads_times_group(std::size_t sensor) const noexcept {
  return std::exp(learnt_[sensor].deviation);
}

bool GroupGains::is_at_bound(std::size_t sensor) const noexcept {
  constexpr double kNearly = 0.99;
  return std::abs(learnt_[sensor].deviation) >= kNearly * most();
}

bool GroupGains::restore(std::span<const Learnt> learnt) {
  if (learnt.size() != learnt_.size()) return false;
  const auto is_bounded = [this](double deviation) { return std::abs(deviation) <= most() + kRounding; };
  double sum = 0.0;
  std::size_t known = 0;
  for (const Learnt& one : learnt) {
    const bool is_valid = std::isfinite(one.deviation) && std::isfinite(one.learnt_s) && one.learnt_s >= 0.0;
    if (!is_valid || !is_bounded(one.deviation)) return false;
    if (!is_known(one)) continue;
    sum += one.deviation;
    ++known;
  }
  if (known == 0) return true;
  const double mean = sum / static_cast<double>(known);
  std::vector<Learnt> centred(learnt.begin(), learnt.end());
  for (Learnt& one : centred) {
    if (!is_known(one)) continue;
    one.deviation -= mean;
    one.learnt_s = std::min(one.learnt_s, settings_.memory_s);
    if (!is_bounded(one.deviation)) return false;
  }
  learnt_ = std::move(centred);
  renew_gains();
  return true;
}

double GroupGains::most() const noexcept {
  return std::log(settings_.most_factor);
}

void GroupGains::renew_gains() noexcept {
  for (std::size_t i = 0; i < gains_.size(); ++i) gains_[i] = std::exp(-learnt_[i].deviation);
}

}  // namespace yuragi::wind::judging
