#include "viewer/stream/pose_history.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::viewer::stream {

void PoseHistory::reset(const PoseMoment& layout) {
  const std::size_t bytes = std::max<std::size_t>(1, value_bytes(layout.poses));
  moments_.assign(std::clamp(kMaxBytes / bytes, kMinMoments, kMaxMoments), layout);
  clear();
}

void PoseHistory::push(PoseMoment& moment) {
  if (count_ == moments_.size()) {
    first_ = (first_ + 1) % moments_.size();
  } else {
    ++count_;
  }
  PoseMoment& place = moments_[(first_ + count_ - 1) % moments_.size()];
  place.time_s = moment.time_s;
  place.tick = moment.tick;
  place.wind = moment.wind;
  place.view_wind_from_deg = moment.view_wind_from_deg;
  std::swap(place.poses, moment.poses);
  std::swap(place.opacities, moment.opacities);
}

void PoseHistory::sample(double time_s, PoseMoment& out) const {
  // The first moment that is later than time_s, by bisection.
  std::size_t low = 0;
  std::size_t high = count_;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (at(middle).time_s > time_s) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  const PoseMoment& after = at(std::min(low, count_ - 1));
  const PoseMoment& before = at(low == 0 ? 0 : low - 1);
  const double span_s = after.time_s - before.time_s;
  blend(before, after, span_s > 0.0 ? (time_s - before.time_s) / span_s : 0.0, out);
}

}  // namespace yuragi::viewer::stream
