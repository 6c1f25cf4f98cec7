#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "engine/wire/wire.hpp"
#include "viewer/stream/pose_moment.hpp"

namespace yuragi::viewer::stream {

/// The age of the readings in the pictures of the last seconds.
struct AgeFigures {
  double newest_s = 0.0;  ///< of the last picture
  double p50_s = 0.0;
  double p95_s = 0.0;
  double max_s = 0.0;
  double display_s = 0.0;         ///< part of each of them: an estimate of the display's own time
  std::size_t pictures = 0;       ///< number of pictures
  bool is_network_known = false;  ///< otherwise the shortest way of a frame through the network is not contained
};

/// Measures the age of the sensor's newest reading at the moment when its picture is seen: from the reading's arrival
/// in the daemon to the animation's tick, by the frame; from there to the picture that was handed to the display,
/// by the viewer's clock; and the display's interval, which is not measured but estimated.
///
/// If the daemon runs on the same machine, both have one clock. Clocks of two machines differ by an unknown time: then
/// the age is counted from the quickest frame's arrival, is too small by its time in the network, and is marked as
/// such.
///
/// Pure: time is a parameter, in seconds. Allocates nothing. Thread-safe: no.
class PictureAge {
 public:
  static constexpr double kSpan_s = 10.0;
  static constexpr std::size_t kMaxPictures = 2048;  ///< above 200 Hz they cover a shorter time

  /// A frame arrived, at the moment arrival_s of the steady clock and arrival_utc_s since 1970. `is_same_machine`: was
  /// it sent by this one?
  void take_frame(const wire::FrameInfo& frame, double arrival_s, double arrival_utc_s, bool is_same_machine);

  /// Call when a picture of this live moment was handed to the display at shown_s. Without a sensor it has no age.
  void take_picture(const PoseMoment& moment, double shown_s, double display_s);

  /// For the pictures of the kSpan_s before now_s; nullopt if there were none.
  std::optional<AgeFigures> figures(double now_s) const;

 private:
  struct Shown {
    double at_s = 0.0;
    double age_s = 0.0;
  };

  bool has_begun_ = false;
  bool is_network_known_ = false;
  double sender_zero_s_ = 0.0;  // zero of the sender's time line, on our clock
  double last_sender_s_ = 0.0;
  double last_arrival_s_ = 0.0;
  double display_s_ = 0.0;
  std::array<Shown, kMaxPictures> shown_{};  // a ring
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

/// For a person: "reading 38 ms old when it was shown (of 10 s: p50 38, p95 45, at most 60 ms; ...)".
std::string age_text(const AgeFigures& age);

}  // namespace yuragi::viewer::stream
