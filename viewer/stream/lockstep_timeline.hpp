#pragma once

#include <span>

#include "viewer/stream/pose_moment.hpp"

namespace yuragi::viewer::stream {

/// The moments between the frames of a stream that waits for its reader: no clock, no delay and no jitter. Each moment
/// depends on the two frames around it alone, so that it is the same every time.
///
/// Pure. Thread-safe: no.
class LockstepTimeline {
 public:
  /// The scenes of the frames that follow.
  void set_scenes(std::span<const wire::SceneModel> scenes);

  /// Takes the next frame; swaps its buffers with old ones. Returns false if it is not of these scenes, or not later
  /// than the one before. A scene of opacity 0 can come without its pose: the last one is used.
  bool accept(wire::Frame& frame);

  /// Has any frame come?
  bool has_begun() const { return count_ > 0; }
  /// On the sender's time line. Only after a frame was taken.
  double newest_s() const { return newest_.time_s; }

  /// The moment at time_s, which is not after newest_s(); before the last but one frame it is that frame. Valid until
  /// the next call.
  const PoseMoment& at(double time_s);

 private:
  PoseMoment before_, newest_, shown_;
  int count_ = 0;  // number of stored frames, up to two
};

}  // namespace yuragi::viewer::stream
