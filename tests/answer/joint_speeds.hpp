#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/pose/kinematics.hpp"
#include "tests/answer/series.hpp"

namespace yuragi::answer {

/// Root mean squares of the velocities of many joints, from two ticks that follow each other out of every few: joints
/// of a tree or a meadow cost as much as its motion.
class JointSpeeds {
 public:
  explicit JointSpeeds(std::vector<std::size_t> joints)
      : joints_(std::move(joints)), before_(joints_.size()), squares_m2_(joints_.size(), 0.0) {}

  static bool needs_joints(std::size_t tick) { return tick % kEvery < 2; }

  void take(std::size_t tick, const pose::Kinematics& joints) {
    if (!needs_joints(tick)) return;
    const bool is_second = tick % kEvery == 1;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const pose::JointPosition place = joints.joint(joints_[i]);
      if (is_second) {
        const auto x_m = static_cast<double>(place.x_m - before_[i].x_m);
        const auto y_m = static_cast<double>(place.y_m - before_[i].y_m);
        const auto z_m = static_cast<double>(place.z_m - before_[i].z_m);
        const double square_m2 = x_m * x_m + y_m * y_m + z_m * z_m;
        squares_m2_[i] += square_m2;
        largest_m2_ = std::max(largest_m2_, square_m2);
      }
      before_[i] = place;
    }
    if (is_second) ++pairs_;
  }

  /// The median over the joints.
  double median_m_s(double rate_hz) const {
    std::vector<double> speeds_m_s;
    const double pairs = std::max(static_cast<double>(pairs_), 1.0);
    for (const double sum_m2 : squares_m2_) speeds_m_s.push_back(rate_hz * std::sqrt(sum_m2 / pairs));
    return median(std::move(speeds_m_s));
  }
  double largest_step_m() const { return std::sqrt(largest_m2_); }

 private:
  static constexpr std::size_t kEvery = 6;

  std::vector<std::size_t> joints_;
  std::vector<pose::JointPosition> before_;
  std::vector<double> squares_m2_;
  double largest_m2_ = 0.0;
  std::size_t pairs_ = 0;
};

}  // namespace yuragi::answer
