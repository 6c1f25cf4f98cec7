#pragma once

#include <optional>

#include "viewer/stream/pose_history.hpp"
#include "viewer/stream/stream_clock.hpp"

namespace yuragi::viewer::stream {

/// The position in a replay back and forth over span_s seconds, elapsed_s after its start: the distance from the start,
/// from 0 to span_s. It starts at rest, moves at a rate of 1 at most, and slows down to rest at each turn.
double back_and_forth_s(double elapsed_s, double span_s);

/// One run of a stream on the sender's time line: the frames that have arrived, and the moment that is shown.
///
/// While frames arrive, the moment shown follows them at the delay of Clock, or a given target; it never goes back, and
/// never passes the newest. When they stop, it comes to rest at the newest and then goes back and forth over the last
/// kReplaySpan_s. Thread-safe: no. Does not allocate once its history is full.
class PoseTrack {
 public:
  static constexpr double kReplaySpan_s = 4.0;
  static constexpr double kMinSilence_s = 0.5;  ///< no frame for this long (or four intervals): the stream has stopped
  static constexpr double kMaxPlayRate = 1.3;   ///< rate of the sender's time line against ours while catching up
  static constexpr double kMinPlayRate = 0.7;
  static constexpr double kMaxTarget_s = 2.0;  ///< farther from the arrivals it is of another run

  void reset(const PoseMoment& layout);
  void clear();

  bool is_empty() const { return history_.is_empty(); }
  bool is_replaying() const { return is_replaying_; }
  double delay_s() const { return clock_.delay_s(); }
  /// The moment that the last advance() was to show, on the sender's time line.
  double shown_s() const { return shown_s_; }

  /// Takes over another track's knowledge of the same sender's clock. Call before the first push().
  void take_clock_of(const PoseTrack& other) { clock_ = other.clock_; }

  /// Returns true if a frame of the moment sender_s, arriving at local_s, can be the next of this run. Returns false if
  /// the sender's time went back, or advanced by much more than ours: then the sender has restarted.
  bool continues(double sender_s, double local_s) const;

  /// Takes a frame that continues(); swaps its poses.
  void push(PoseMoment& moment, double local_s);

  /// Advances to local_s and writes the moment to show. It follows target_s, if that is given and within kMaxTarget_s
  /// of what the arrivals suggest; otherwise these. Not while is_empty().
  void advance(double local_s, std::optional<double> target_s, PoseMoment& out);

 private:
  double follow_s(double passed_s, double target_s) const;

  PoseHistory history_;
  Clock clock_;
  double shown_s_ = 0.0;  // the moment shown, on the sender's time line
  double last_local_s_ = 0.0;
  bool has_advanced_ = false;
  bool is_replaying_ = false;
  double replay_elapsed_s_ = 0.0;
};

}  // namespace yuragi::viewer::stream
