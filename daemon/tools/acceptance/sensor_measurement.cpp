#include "daemon/tools/acceptance/sensor_measurement.hpp"

#include <algorithm>
#include <numeric>

#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/pose_hash.hpp"

namespace yuragi::daemon::tools::acceptance {
namespace {

std::uint64_t hash_of(const std::vector<pose::Pose>& poses) {
  std::uint64_t hash = pose::kPoseHashSeed;
  for (const pose::Pose& one : poses) {
    pose::for_each_array(one, [&](std::span<const float> values) { hash = pose::pose_hash(hash, values); });
  }
  return hash;
}

/// The middle one of at least one value.
double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

void SensorMeasurement::take(const wire::Message& message, Instant now) {
  if (!begun_) begun_ = now.mono;
  if (const auto* frame = std::get_if<wire::Frame>(&message)) take_frame(*frame, now);
  if (const auto* sensors = std::get_if<wire::Sensors>(&message)) {
    const auto found = std::ranges::find(sensors->sensors, sensor_, &wire::SensorStatus::name);
    if (found != sensors->sensors.end()) take_status(*found, now);
  }
}

void SensorMeasurement::take_frame(const wire::Frame& frame, Instant now) {
  const wind::State& wind = frame.info.wind;
  const SeenFrame seen{wind.reading_age_s, hash_of(frame.poses)};
  ++measured_.frames;
  measured_.largest_live_weight = std::max(measured_.largest_live_weight, wind.live_weight);
  if (last_frame_) {
    if (seen.poses != last_frame_->poses) ++measured_.moved_frames;
    // It grows until a new reading takes part.
    const bool is_new = wind.reading_age_s < last_frame_->reading_age_s;
    if (is_new && wind.live_weight > 0.0) {
      const double on_the_way_s = 1e-9 * static_cast<double>(now.utc.time_since_epoch().count() - frame.info.utc_ns);
      delays_s_.push_back(wind.reading_age_s + std::max(on_the_way_s, 0.0));
    }
  }
  last_frame_ = seen;
}

void SensorMeasurement::take_status(const wire::SensorStatus& status, Instant now) {
  measured_.status = status;
  if (status.readings == 0) return;
  if (!first_reading_) {
    first_reading_ = now.mono;
    measured_.first_reading_s = std::max(0.0, seconds(now.mono - *begun_) - status.age_s);
  }
  if (status.speed_m_s) speeds_m_s_.push_back(*status.speed_m_s);
}

SensorMeasured SensorMeasurement::result(Instant now) const {
  SensorMeasured measured = measured_;
  if (begun_) measured.measured_s = seconds(now.mono - first_reading_.value_or(*begun_));
  if (!speeds_m_s_.empty()) {
    const auto [least, largest] = std::ranges::minmax_element(speeds_m_s_);
    measured.least_speed_m_s = *least;
    measured.largest_speed_m_s = *largest;
    measured.mean_speed_m_s =
        std::accumulate(speeds_m_s_.begin(), speeds_m_s_.end(), 0.0) / static_cast<double>(speeds_m_s_.size());
  }
  measured.delays = delays_s_.size();
  if (!delays_s_.empty()) {
    measured.median_delay_s = median_of(delays_s_);
    measured.longest_delay_s = *std::ranges::max_element(delays_s_);
  }
  return measured;
}

}  // namespace yuragi::daemon::tools::acceptance
