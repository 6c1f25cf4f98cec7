#pragma once

#include "viewer/stream/pose_moment.hpp"

namespace yuragi::viewer::app {

/// Keeps the picture as it is while a person has paused it, and cross-fades from there to what is live when it goes
/// on. What came meanwhile is not shown: whoever calls this lets the stream's timeline go on and drop it. Where the
/// scenes have become others, it goes on without a cross-fade. Pure: time is a parameter. Thread-safe: no.
class PausedMoment {
 public:
  static constexpr double kFade_s = 1.0;

  void toggle() { is_paused_ = !is_paused_; }
  bool is_paused() const { return is_paused_; }

  /// What to show where `live` would be shown without a pause: valid until the next call, or as long as `live` is.
  const stream::PoseMoment& advance(const stream::PoseMoment& live, double passed_s);

 private:
  bool is_paused_ = false;
  bool is_held_ = false;
  double fade_ = 1.0;  // from held_ (0) to what is live (1)
  stream::PoseMoment held_, shown_;
};

}  // namespace yuragi::viewer::app
