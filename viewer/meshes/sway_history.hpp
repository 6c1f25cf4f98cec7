#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

namespace yuragi::viewer::meshes {

/// How far a tree was blown in the last seconds, for its copies far away: a gust reaches one after the other, carried
/// by the mean wind (G. I. Taylor 1938, "The spectrum of turbulence": gusts change little on their way). An estimate:
/// the stream has the pose of one tree, and the wind at one place. Allocates when it is made, never afterwards.
class SwayHistory {
 public:
  static constexpr double kLongest_s = 8.0;  ///< no copy is later than this

  SwayHistory();

  /// Vectors toward east and south. Where time goes back or jumps ahead, it begins anew.
  void add(double time_s, const glm::vec2& sway_m, const glm::vec2& wind_m_s);

  /// How far downwind a place is, metres, by the mean wind.
  float downwind_m(const glm::vec2& place_m) const;
  /// How long gusts take for that, at most kLongest_s.
  double delay_s(float downwind_m) const;
  /// How far the tree was blown so long ago; 0 before anything is added.
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
