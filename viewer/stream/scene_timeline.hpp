#pragma once

#include <optional>
#include <vector>

#include "viewer/stream/fixed_delay.hpp"
#include "viewer/stream/pose_timeline.hpp"

namespace yuragi::viewer::stream {

/// The scenes that are shown and their poses, while the daemon may exchange the scenes for others.
///
/// The old scenes are shown until the first frame of the new ones is due: so every scene has a pose, no moment is
/// skipped, and none is interpolated between two lists of scenes. Scenes with the same skeletons as before (after a
/// restart of the daemon, or with another name) continue to move. An empty list is shown at once: it has no frames to
/// wait for.
///
/// Pure: time is a parameter, as in PoseTimeline. Thread-safe: no.
class SceneTimeline {
 public:
  /// `fixed_delay_s`: pictures are this much behind UTC, as FixedDelay has it; nullopt: as little as arrivals allow.
  explicit SceneTimeline(std::optional<double> fixed_delay_s = std::nullopt);

  /// The scenes of the frames that follow.
  void set_scenes(wire::Scenes scenes);

  /// Takes a frame that arrived at local_s; swaps its buffers with old ones. Returns false if it is not of these
  /// scenes.
  bool accept(wire::Frame& frame, double local_s);

  /// Advances to local_s, which is utc_s since 1970; without a fixed delay utc_s is not used. Returns the moment to
  /// show, valid until the next call.
  const PoseMoment& advance(double local_s, double utc_s = 0.0);

  /// Returns the scenes of the last advance() if they have changed since the last call.
  std::optional<std::vector<wire::SceneModel>> take_new_scenes();

  Playback playback() const { return present_.playback(); }

  /// Nullopt without one.
  const std::optional<FixedDelay>& fixed_delay() const { return fixed_delay_; }

 private:
  std::optional<FixedDelay> fixed_delay_;
  PoseTimeline present_;
  std::vector<wire::SceneModel> scenes_;  // of present_
  bool has_scenes_ = false;
  bool is_news_ = false;  // not yet returned

  std::optional<PoseTimeline> next_;  // for the scenes that are shown next
  std::vector<wire::SceneModel> next_scenes_;
  std::optional<double> next_begins_s_;  // the sender's time of their first frame
};

}  // namespace yuragi::viewer::stream
