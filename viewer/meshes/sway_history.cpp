#include "viewer/meshes/sway_history.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace yuragi::viewer::meshes {
namespace {

constexpr double kSpacing_s = 1.0 / 30.0;
constexpr double kMaxGap_s = 1.0;
constexpr double kMeanOver_s = 10.0;
constexpr float kSlowest_m_s = 1.0F;  // a weaker wind has no visible effect

}  // namespace

SwayHistory::SwayHistory() : moments_(static_cast<std::size_t>(std::ceil(kLongest_s / kSpacing_s)) + 2) {}

void SwayHistory::add(double time_s, const glm::vec2& sway_m, const glm::vec2& wind_m_s) {
  const double gap_s = time_s - moments_[newest_].time_s;
  if (count_ == 0 || gap_s < 0.0 || gap_s > kMaxGap_s) {
    newest_ = 0;
    count_ = 1;
    wind_m_s_ = wind_m_s;
  } else {
    wind_m_s_ += static_cast<float>(1.0 - std::exp(-gap_s / kMeanOver_s)) * (wind_m_s - wind_m_s_);
    // The newest moves on until it is far enough from the one before.
    const Moment& before = moments_[(newest_ + moments_.size() - 1) % moments_.size()];
    if (count_ == 1 || moments_[newest_].time_s - before.time_s >= kSpacing_s) {
      newest_ = (newest_ + 1) % moments_.size();
      count_ = std::min(count_ + 1, moments_.size());
    }
  }
  moments_[newest_] = {time_s, sway_m};
}

float SwayHistory::downwind_m(const glm::vec2& place_m) const {
  const float speed_m_s = glm::length(wind_m_s_);
  return speed_m_s > 0.0F ? glm::dot(place_m, wind_m_s_) / speed_m_s : 0.0F;
}

double SwayHistory::delay_s(float downwind_m) const {
  const float way_s = downwind_m / std::max(glm::length(wind_m_s_), kSlowest_m_s);
  return std::clamp(static_cast<double>(way_s), 0.0, kLongest_s);
}

glm::vec2 SwayHistory::sway_m(double delay_s) const {
  if (count_ == 0) return glm::vec2(0.0F);
  const double wanted_s = moments_[newest_].time_s - delay_s;
  std::size_t later = newest_;
  for (std::size_t back = 1; back < count_; ++back) {
    const std::size_t earlier = (newest_ + moments_.size() - back) % moments_.size();
    if (moments_[earlier].time_s <= wanted_s) {
      const double whole_s = moments_[later].time_s - moments_[earlier].time_s;
      const double part = whole_s > 0.0 ? (wanted_s - moments_[earlier].time_s) / whole_s : 1.0;
      return glm::mix(moments_[earlier].sway_m, moments_[later].sway_m, static_cast<float>(std::clamp(part, 0.0, 1.0)));
    }
    later = earlier;
  }
  return moments_[later].sway_m;
}

}  // namespace yuragi::viewer::meshes
