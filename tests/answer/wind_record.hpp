#pragma once

#include "engine/wind/wind_vector.hpp"
#include "tests/answer/series.hpp"
#include "tests/answer/tracks.hpp"

namespace yuragi::answer {

/// The wind of each frame of a record, and what it was like.
class WindRecord {
 public:
  void take(wind::Vector wind);

  const Series& east_m_s() const { return east_m_s_; }
  const Series& south_m_s() const { return south_m_s_; }
  Series speed_m_s() const;
  Series squared_speed_m2_s2() const;

  double mean_speed_m_s() const;  ///< of the speed
  double intensity() const;       ///< standard deviation along the mean wind over its speed
  Horizontal downwind() const;    ///< unit vector of the mean wind

  /// How well a scene's answer follows the force of the wind: the correlation of a figure of the scene with the square
  /// of the wind's speed, both averaged over 2 s.
  double answer_of(const Series& figure) const;

 private:
  Series east_m_s_, south_m_s_;
};

/// How many ticks the answer and the wind are averaged over.
inline constexpr std::size_t kAnswerTicks = 120;

}  // namespace yuragi::answer
