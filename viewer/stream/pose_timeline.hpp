#pragma once

#include <array>
#include <optional>
#include <span>

#include "viewer/stream/pose_track.hpp"

namespace yuragi::viewer::stream {

/// What is being shown.
enum class Playback : std::uint8_t {
  kNothing,    ///< no frame received yet: the rest pose
  kLive,       ///< the frames that arrive, interpolated
  kReplaying,  ///< the stream has stopped: its last seconds are played back and forth
  kReturning,  ///< the stream has resumed: a cross-fade from the replay to it
};

/// Makes a motion that never jumps from frames that arrive unevenly, stop and resume.
///
/// Pure: time is a parameter, in seconds of any steady clock, and must not go back. Between two calls of advance() that
/// are dt apart the shown moment moves by at most PoseTrack::kMaxPlayRate dt along a run of the stream; the cross-fade
/// from one run to another takes kFade_s. Thread-safe: no. Once its history is full nothing is allocated, except for
/// poses that a frame omits.
class PoseTimeline {
 public:
  static constexpr double kFade_s = 1.0;
  static constexpr double kMaxFadeStep_s = 0.1;  ///< a picture that took long does not skip the fade

  /// The scenes of the frames that follow. If their layout is the same as before (the daemon has been restarted), the
  /// motion continues; otherwise it starts from the rest pose.
  void set_scenes(std::span<const wire::SceneModel> scenes);

  /// Takes a frame that arrived at local_s; swaps its buffers with old ones. Returns false if it is not of these
  /// scenes. A scene of opacity 0 can come without its pose: the last one shown is used.
  bool accept(wire::Frame& frame, double local_s);

  /// Advances to local_s, toward the moment target_s of the sender's time line; nullopt: toward that of the arrivals.
  /// Returns the moment to show, valid until the next call.
  const PoseMoment& advance(double local_s, std::optional<double> target_s = std::nullopt);

  /// Can a frame of the moment sender_s, arriving at local_s, be the next of the run that is shown?
  bool continues(double sender_s, double local_s) const {
    return !current().is_empty() && current().continues(sender_s, local_s);
  }
  /// Takes over another timeline's knowledge of the same sender's clock. Call before the first frame.
  void take_clock_of(const PoseTimeline& other) { current().take_clock_of(other.current()); }
  /// The moment that the last advance() was to show, on the sender's time line. Not before the first frame.
  double shown_s() const { return current().shown_s(); }

  Playback playback() const;
  /// How far the picture is behind the frame with the shortest delay.
  double delay_s() const { return current().delay_s(); }

 private:
  void stand_in_for_hidden(wire::Frame& frame) const;
  PoseTrack& current() { return tracks_[current_]; }
  const PoseTrack& current() const { return tracks_[current_]; }
  bool is_fading() const { return fade_ < 1.0; }

  PoseMoment incoming_;  // the frame being accepted
  PoseMoment shown_;
  PoseMoment faded_;  // the moment shown of the outgoing track
  std::array<PoseTrack, 2> tracks_;
  std::size_t current_ = 0;
  double fade_ = 1.0;  // from the outgoing track (0) to the current one (1)
  double last_local_s_ = 0.0;
};

}  // namespace yuragi::viewer::stream
