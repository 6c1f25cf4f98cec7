#pragma once

#include <optional>
#include <vector>

#include "viewer/stream/pose_timeline.hpp"

namespace yuragi::viewer::stream {

/// The scenes that are shown and their poses, while the daemon may exchange the scenes for others.
///
/// The scenes of before are shown, each moment of the sender's time at its place, until the first frame of the new ones
/// is due: so nothing is ever without a pose, no moment is passed over, and none is interpolated between two lists of
/// scenes. Scenes whose skeletons are the same as before (a daemon that was restarted, another name) go on moving. An
/// empty list is shown at once: it has no frames to wait for.
///
/// Pure: time is a parameter, as in PoseTimeline. Thread-safe: no.
class SceneTimeline {
 public:
  /// The scenes of the frames that follow.
  void set_scenes(wire::Scenes scenes);

  /// Takes a frame that arrived at local_s; swaps its buffers with old ones. False where it is not of these scenes.
  bool accept(wire::Frame& frame, double local_s);

  /// Advances to local_s. Returns the moment to show, valid until the next call.
  const PoseMoment& advance(double local_s);

  /// The scenes that the moment of the last advance() is of, where they are others than when this was asked before.
  std::optional<std::vector<wire::SceneModel>> take_new_scenes();

  Playback playback() const { return present_.playback(); }

 private:
  PoseTimeline present_;
  std::vector<wire::SceneModel> scenes_;  // of present_
  bool has_scenes_ = false;
  bool is_news_ = false;  // they have not been taken

  std::optional<PoseTimeline> next_;  // of the scenes that are to be shown
  std::vector<wire::SceneModel> next_scenes_;
  std::optional<double> next_begins_s_;  // the sender's time of their first frame
};

}  // namespace yuragi::viewer::stream
