#include "engine/wind/following_estimator.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi {
namespace {

constexpr double kAssumedInterval_s = 2.0;  // of a source that has spoken once
constexpr double kMinStaleAfter_s = 1.0;

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

double FollowingEstimator::Source::interval_s() const noexcept {
  const std::size_t count = std::min(intervals_seen, kIntervalsKept);
  if (count == 0) return 0.0;
  auto sorted = intervals_s;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

void FollowingEstimator::Source::measure_interval(MonoTime time) noexcept {
  if (!last) return;
  const double interval = seconds(time - last->time.mono);
  if (interval <= 0.0) return;
  intervals_s[intervals_seen % kIntervalsKept] = interval;
  ++intervals_seen;
}

bool FollowingEstimator::accept(std::size_t index, const WindReading& reading) noexcept {
  if (index >= sources_.size() || !is_plausible(reading)) return false;
  Source& source = sources_[index];

  // A reading without a direction blows from where the source last said, or from where the wind usually comes here.
  if (reading.direction_deg) source.held_from_deg = reading.direction_deg;
  const double from_deg = source.held_from_deg.value_or(settings_.default_wind.mean_direction_deg);
  source.target = wind_from(reading.speed_m_s, from_deg);

  // The first reading of all is where its follower begins; its weight is still 0, so that nothing jumps.
  if (!source.last) {
    source.u.value = source.target.u_m_s;
    source.v.value = source.target.v_m_s;
  }
  source.measure_interval(reading.time.mono);
  source.last = reading;
  return true;
}

double FollowingEstimator::age_s(const Source& source) const noexcept {
  return source.last ? std::max(0.0, seconds(state_.time - source.last->time.mono)) : 0.0;
}

bool FollowingEstimator::is_live(const Source& source) const noexcept {
  if (!source.last) return false;
  const double interval = source.intervals_seen > 0 ? source.interval_s() : kAssumedInterval_s;
  return age_s(source) <= std::max(kMinStaleAfter_s, settings_.stale_intervals * interval);
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
    if (!source.last) continue;
    const double interval = source.intervals_seen > 0 ? source.interval_s() : kAssumedInterval_s;
    const double follow_rad_s =
        std::clamp(kFollowRateTimesInterval / interval, kMinFollowRate_rad_s, kMaxFollowRate_rad_s);
    source.u.step(source.target.u_m_s, follow_rad_s, dt_s);
    source.v.step(source.target.v_m_s, follow_rad_s, dt_s);
    source.weight.step(&source == chosen ? 1.0 : 0.0, handover_rad_s, dt_s);
    live = live + source.weight.value * WindVector{source.u.value, source.v.value};
    live_weight += source.weight.value;
  }

  const WindVector climate = default_wind_.at(seconds(now - *begun_));
  state_.wind = live + (1.0 - live_weight) * climate;
  state_.live_weight = std::clamp(live_weight, 0.0, 1.0);
  state_.reading_age_s = chosen != nullptr ? age_s(*chosen) : 0.0;
  state_.source = live_weight > 0.99   ? WindSource::kLive
                  : live_weight < 0.01 ? WindSource::kDefault
                                       : WindSource::kHandover;
  return state_;
}

SourceReport FollowingEstimator::report(std::size_t index) const noexcept {
  const Source& source = sources_[index];
  if (!source.last) return {};
  return {.health = is_live(source) ? SourceHealth::kLive : SourceHealth::kStale,
          .interval_s = source.interval_s(),
          .age_s = age_s(source),
          .last = source.last};
}

}  // namespace yuragi
