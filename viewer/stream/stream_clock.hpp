#pragma once

namespace yuragi::viewer::stream {

/// Which moment of the sender's time line to show now, estimated from the frames' arrivals.
///
/// The arrivals with the shortest delay give the difference of the two clocks. A frame is needed until the next one
/// arrives: the picture must lag by that one's delay and the interval between the two, so that it need not wait. It
/// lags by the maximum of this over the last seconds, whether frames were late or lost, plus half a frame interval, and
/// catches up as the maximum is forgotten. This is the method of playout delay for sound on networks: R. Ramjee, J.
/// Kurose, D. Towsley and H. Schulzrinne, "Adaptive playout mechanisms for packetized audio applications in wide-area
/// networks", INFOCOM 1994. Thread-safe: no. Never fails: times are finite.
class Clock {
 public:
  static constexpr double kMaxDelay_s = 0.5;

  /// A frame of the moment sender_s arrived at local_s.
  void observe(double sender_s, double local_s);

  /// The moment to show at local_s. Not before the first observe().
  double target_s(double local_s) const { return quickest_s(local_s) - delay_s(); }

  /// The moment of a frame that would arrive at local_s with the shortest delay. Not before the first observe().
  double quickest_s(double local_s) const { return local_s - offset_s_; }

  /// The time between two frames, on the sender's time line.
  double interval_s() const { return interval_s_; }

  /// How far target_s() stays behind the arrival with the shortest delay.
  double delay_s() const;

  double last_arrival_s() const { return last_local_s_; }

 private:
  bool has_observed_ = false;
  double last_sender_s_ = 0.0;
  double last_local_s_ = 0.0;
  double offset_s_ = 0.0;  // local - sender of the quickest arrivals
  double wait_s_ = 0.0;    // the longest for the next frame, of late: its lateness and the time between the two
  double interval_s_ = 1.0 / 60.0;
};

}  // namespace yuragi::viewer::stream
