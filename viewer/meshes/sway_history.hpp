#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

namespace yuragi::viewer::meshes {

/// The bend of a tree in the last seconds, for its copies far away: a gust reaches them in turn, carried by the mean
/// wind (G. I. Taylor 1938, "The spectrum of turbulence": gusts change little on their way). An estimate: the stream
/// has the pose of one tree, and the wind at one place. Allocates when it is made, never afterwards.
class SwayHistory {
 public:
  static constexpr double kLongest_s = 8.0;  ///< the maximum delay of a copy

  SwayHistory();

  /// Vectors toward east and south. If time goes back or jumps ahead, it starts again.
  void add(double time_s, const glm::vec2& sway_m, const glm::vec2& wind_m_s);

  /// How far downwind a place is, metres, by the mean wind.
  float downwind_m(const glm::vec2& place_m) const;
  /// How long gusts take for that, at most kLongest_s.
  double delay_s(float downwind_m) const;
  /// The bend of the tree this long ago; 0 before the first value.
  glm::vec2 sway_m(double delay_s) const;

 private:
  struct Moment {
    double time_s = 0.0;
    glm::vec2 sway_m{0.0F};
  };

  std::vector<Moment> moments_;  // a ring
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  glm::vec2 wind_m_s_{0.0F};  // of the last ten seconds or so
};

}  // namespace yuragi::viewer::meshes
