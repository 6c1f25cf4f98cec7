#include "viewer/app/paused_moment.hpp"

#include <algorithm>

namespace yuragi::viewer::app {

const stream::PoseMoment& PausedMoment::advance(const stream::PoseMoment& live, double passed_s) {
  if (is_paused_) {
    // A pause during the cross-fade after another pause holds the mixed picture.
    if (!is_held_) held_ = fade_ < 1.0 ? shown_ : live;
    is_held_ = true;
    fade_ = 0.0;
    return held_;
  }
  is_held_ = false;
  if (!stream::has_same_layout(held_.poses, live.poses)) fade_ = 1.0;
  if (fade_ >= 1.0) return live;
  fade_ = std::min(1.0, fade_ + std::max(0.0, passed_s) / kFade_s);
  shown_ = live;
  stream::blend(held_, live, fade_ * fade_ * (3.0 - 2.0 * fade_), shown_);
  return shown_;
}

}  // namespace yuragi::viewer::app
