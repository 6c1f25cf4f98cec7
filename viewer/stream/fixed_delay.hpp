#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/wire/wire.hpp"
#include "viewer/stream/stream_clock.hpp"

namespace yuragi::viewer::stream {

/// How a stream keeps its fixed delay.
struct DelayFigures {
  double delay_s = 0.0;
  bool is_kept = false;           ///< the last picture was chosen by the fixed delay
  std::uint64_t frames = 0;       ///< arrived while the delay was kept
  std::uint64_t late_frames = 0;  ///< of these, those that a picture had to wait for
  std::uint64_t losses = 0;       ///< how many times the delay was given up because of a clock
};

/// Which moment of the sender's time line to show, so that viewers on several machines show the same one at the same
/// time: that of the UTC a fixed delay ago, by the UTC of the frames. A frame gives the UTC of the zero of the sender's
/// time line; the earliest of the last frames counts, because a late tick is stamped late.
///
/// The moment depends on UTC and the frames' content alone, not on when they arrive. Arrivals decide whether it can be
/// shown: if no frame arrives in time, or frames arrive before they were made, a clock is wrong. Then there is no
/// target, and the viewer follows the arrivals (Clock) until the clocks have agreed for kReturn_s.
///
/// Pure: time is a parameter. Thread-safe: no. Allocates nothing, except in doubt_text().
class FixedDelay {
 public:
  static constexpr double kMaxEarliness_s = 0.1;  ///< a frame that arrives so long before its UTC: a clock is wrong
  static constexpr double kStep_s = 0.1;          ///< the UTC of the sender's zero moved by more: another run, or clock
  static constexpr double kReturn_s = 3.0;
  static constexpr int kSettling_frames = 30;  ///< that arrive before one of another line counts as too slow

  /// `delay_s` is finite and above 0.
  explicit FixedDelay(double delay_s) { figures_.delay_s = delay_s; }

  /// A frame arrived at local_s.
  void take_frame(const wire::FrameInfo& frame, double local_s);

  /// The moment of the sender's time line to show at local_s, which is utc_s since 1970; may be later than the newest
  /// frame. Nullopt: follow the arrivals.
  std::optional<double> target_s(double local_s, double utc_s);

  const DelayFigures& figures() const { return figures_; }

  /// Is the delay given up because of a clock?
  bool is_in_doubt() const { return is_in_doubt_; }
  /// Why, and what to do, for a person. Only while is_in_doubt().
  std::string doubt_text() const;

 private:
  bool has_begun_ = false;
  double zero_utc_s_ = 0.0;  // of the sender's time line
  double last_sender_s_ = 0.0;
  int frames_ = 0;  // of this line, up to kSettling_frames
  Clock arrivals_;
  std::optional<double> utc_at_zero_s_;  // of our steady clock, by the last picture
  double way_s_ = 0.0;                   // the shortest, from a frame's UTC to its arrival by our clock
  bool is_in_doubt_ = false;
  std::optional<double> agreed_since_s_;  // the clocks
  DelayFigures figures_;
};

/// For a person: "delay 120 ms kept; 3 of 5000 frames late; given up 0 times".
std::string delay_text(const DelayFigures& figures);

}  // namespace yuragi::viewer::stream
