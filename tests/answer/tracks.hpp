#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/pose/kinematics.hpp"
#include "engine/pose/skeleton.hpp"
#include "tests/answer/series.hpp"

namespace yuragi::answer {

/// A horizontal direction or way in the world: east and south.
struct Horizontal {
  double east = 0.0;
  double south = 0.0;

  double dot(Horizontal other) const { return east * other.east + south * other.south; }
  double length() const;
  Horizontal unit() const;                             ///< (0, 1) of nothing
  Horizontal aside() const { return {-south, east}; }  ///< turned by a quarter
};

/// Where some joints have been: one series a coordinate, of a sample a tick.
class JointTracks {
 public:
  /// The joints' numbers, as Kinematics::joint() counts them.
  explicit JointTracks(std::vector<std::size_t> joints);

  void take(const pose::Kinematics& joints);

  std::size_t count() const { return joints_.size(); }
  const Series& x_m(std::size_t joint) const { return axes_m_[0][joint]; }
  const Series& y_m(std::size_t joint) const { return axes_m_[1][joint]; }
  const Series& z_m(std::size_t joint) const { return axes_m_[2][joint]; }

  /// The part of the way from one joint to another that is along a horizontal direction.
  Series way_m(std::size_t from, std::size_t to, Horizontal along) const;
  /// Its mean, east and south.
  Horizontal mean_way_m(std::size_t from, std::size_t to) const;
  /// The angle from straight down of the way from one joint to another, degrees.
  Series angle_from_down_deg(std::size_t from, std::size_t to) const;

  /// Root mean square of a joint's velocity.
  double speed_m_s(std::size_t joint, double rate_hz) const;
  /// How far a joint has moved at most between two samples.
  double largest_step_m() const;

 private:
  std::vector<std::size_t> joints_;
  std::array<std::vector<Series>, 3> axes_m_;
};

/// How some strands have been bent: the pose's vector, degrees. Of a tree: strands of one level.
class BendTracks {
 public:
  explicit BendTracks(std::vector<std::size_t> strands, std::size_t level = 0);

  void take(const pose::Pose& pose);

  std::size_t count() const { return strands_.size(); }
  std::size_t strand(std::size_t index) const { return strands_[index]; }
  const Series& east_deg(std::size_t index) const { return east_deg_[index]; }
  const Series& south_deg(std::size_t index) const { return south_deg_[index]; }

  /// The part of each bend along a horizontal unit vector.
  std::vector<Series> along_deg(Horizontal unit) const;

 private:
  std::vector<std::size_t> strands_;
  std::size_t level_;
  std::vector<Series> east_deg_, south_deg_;
};

/// At most `most` of the numbers below `count`, spread evenly, the first and the last among them.
std::vector<std::size_t> spread(std::size_t count, std::size_t most);

/// The mean over the series at each moment.
Series mean_at_each_moment(const std::vector<Series>& series);

/// By how much the series differ at one moment: the standard deviation over them, each less its own mean over time, as
/// the root of its mean square over time.
double difference_at_one_moment(const std::vector<Series>& series);

}  // namespace yuragi::answer
