#pragma once

#include "viewer/stream/pose_moment.hpp"

namespace yuragi::viewer::app {

/// Holds the picture while a person has paused it, and cross-fades to the live one when the pause ends. Frames of the
/// pause are not shown: the caller continues to advance the stream's timeline and drops them. If the scenes have
/// changed, there is no cross-fade. Pure: time is a parameter. Thread-safe: no.
class PausedMoment {
 public:
  static constexpr double kFade_s = 1.0;

  void toggle() { is_paused_ = !is_paused_; }
  bool is_paused() const { return is_paused_; }

  /// Returns the moment to show instead of `live`: valid until the next call, or as long as `live` is.
  const stream::PoseMoment& advance(const stream::PoseMoment& live, double passed_s);

 private:
  bool is_paused_ = false;
  bool is_held_ = false;
  double fade_ = 1.0;  // from held_ (0) to what is live (1)
  stream::PoseMoment held_, shown_;
};

}  // namespace yuragi::viewer::app
