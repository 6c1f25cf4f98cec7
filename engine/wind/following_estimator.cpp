#include "engine/wind/following_estimator.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi {
namespace {

// A follower settles within about one interval of its source; slower than this it would feel dead, quicker it would
// show each reading of a fast sensor as a step.
constexpr double kMinFollowRate_rad_s = 0.1;
constexpr double kMaxFollowRate_rad_s = 25.0;
constexpr double kFollowRateTimesInterval = 4.0;

// A critically damped step has done 91 % of its way after 4 time constants.
constexpr double kHandoverRateTimesDuration = 4.0;

}  // namespace

FollowingEstimator::FollowingEstimator(std::size_t source_count, const FollowingEstimatorSettings& settings)
    : settings_(settings), default_wind_(settings.default_wind), sources_(source_count) {
  state_.wind = default_wind_.at(0.0);
}

bool FollowingEstimator::accept(std::size_t index, const WindReading& reading) noexcept {
  if (index >= sources_.size() || !is_plausible(reading)) return false;
  Source& source = sources_[index];

  const bool is_first = !source.record.has_spoken();
  source.record.take(reading, settings_.default_wind.mean_direction_deg);

  // The first reading of all is where its follower begins; its weight is still 0, so that nothing jumps.
  if (is_first) {
    source.u.value = source.record.wind().u_m_s;
    source.v.value = source.record.wind().v_m_s;
  }
  return true;
}

bool FollowingEstimator::is_live(const Source& source) const noexcept {
  return source.record.is_live(state_.time, settings_.stale_intervals);
}

const FollowingEstimator::Source* FollowingEstimator::choose() const noexcept {
  const auto found = std::ranges::find_if(sources_, [this](const Source& source) { return is_live(source); });
  return found == sources_.end() ? nullptr : &*found;
}

WindState FollowingEstimator::advance(MonoTime now) noexcept {
  if (!begun_) {
    begun_ = now;
    state_.time = now;
  }
  if (now < state_.time) return state_;
  const double dt_s = seconds(now - state_.time);
  state_.time = now;

  // Each source follows its own readings; the chosen one's weight grows, the others' fall.
  const Source* chosen = choose();
  const double handover_rad_s = kHandoverRateTimesDuration / settings_.handover_s;
  WindVector live{};
  double live_weight = 0.0;
  for (Source& source : sources_) {
    if (!source.record.has_spoken()) continue;
    const double follow_rad_s = std::clamp(kFollowRateTimesInterval / source.record.expected_interval_s(),
                                           kMinFollowRate_rad_s, kMaxFollowRate_rad_s);
    source.u.step(source.record.wind().u_m_s, follow_rad_s, dt_s);
    source.v.step(source.record.wind().v_m_s, follow_rad_s, dt_s);
    source.weight.step(&source == chosen ? 1.0 : 0.0, handover_rad_s, dt_s);
    live = live + source.weight.value * WindVector{source.u.value, source.v.value};
    live_weight += source.weight.value;
  }

  const WindVector climate = default_wind_.at(seconds(now - *begun_));
  state_.wind = live + (1.0 - live_weight) * climate;
  state_.live_weight = std::clamp(live_weight, 0.0, 1.0);
  state_.reading_age_s = chosen != nullptr ? chosen->record.age_s(now) : 0.0;
  state_.source = live_weight > 0.99   ? WindSource::kLive
                  : live_weight < 0.01 ? WindSource::kDefault
                                       : WindSource::kHandover;
  return state_;
}

SourceReport FollowingEstimator::report(std::size_t index) const noexcept {
  return sources_[index].record.report(state_.time, settings_.stale_intervals);
}

}  // namespace yuragi
