#pragma once

#include <optional>
#include <span>
#include <vector>

namespace yuragi::drivers::decode::microphone {

struct MicDirectionEstimate {
  double direction_deg = 0.0;  ///< where the wind comes from, clockwise from north, [0, 360)
  double confidence = 0.0;     ///< 0 to 1: how much louder one side is, times how steadily it is the same side
};

/// The direction of the wind by microphones that face different ways: the one that faces the wind is the loudest. A
/// cosine about the compass, s = s0 + s1 cos(face - direction), is fitted to the speeds by each microphone, and
/// smoothed as a vector, so that 350 and 10 degrees make 0 (drivers/SOURCES.md S6.4). Thread-safe: no. Realtime-safe
/// after construction: yes.
class MicDirection {
 public:
  /// Where each microphone faces, degrees clockwise from north: three at least, not all within one half circle's line.
  /// Throws std::invalid_argument if a cosine cannot be fitted to them.
  MicDirection(const std::vector<double>& faces_deg, double smoothing_s);

  /// Adds the speeds by each microphone, valid for `duration_s`. Returns nullopt in a calm.
  std::optional<MicDirectionEstimate> add(std::span<const double> speeds_m_s, double duration_s) noexcept;

  void restart() noexcept;

 private:
  struct Weights {
    double mean, north, east;
  };
  std::vector<Weights> fit_;  ///< the weights of each face in the fitted mean, cosine and sine
  double smoothing_s_;
  double north_ = 0.0, east_ = 0.0, mean_ = 0.0, length_ = 0.0;  ///< smoothed
  double weight_ = 0.0;
};

}  // namespace yuragi::drivers::decode::microphone
