#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/skeleton.hpp"

namespace yuragi::daemon::animation {

/// Hides that scenes were put into another state: what is shown is their pose and, added to it, the difference to what
/// was shown before, which fades within kSettling_s. So neither a joint nor its motion jumps, and the scenes
/// themselves move on undisturbed.
///
/// Allocates only in its constructor. Thread-safe: no. Realtime-safe: yes.
class SettlingPoses {
 public:
  static constexpr double kSettling_s = 1.5;

  explicit SettlingPoses(std::span<const pose::Skeleton* const> skeletons) : before_opacities_(skeletons.size()) {
    for (const pose::Skeleton* skeleton : skeletons) {
      before_.push_back(pose::rest_pose(*skeleton));
      shown_.push_back(before_.back());
    }
    for (const pose::Pose& pose : shown_) pointers_.push_back(&pose);
    shown_opacities_ = before_opacities_;
  }

  /// Call it before the scenes' state changes, with the poses as they are: keeps what is shown now.
  void keep(std::span<const pose::Pose* const> poses, std::span<const float> opacities) noexcept {
    show(poses, opacities);
    for (std::size_t i = 0; i < before_.size(); ++i) copy(shown_[i], before_[i]);
    std::ranges::copy(shown_opacities_, before_opacities_.begin());
    is_kept_ = true;
    left_s_ = kSettling_s;
  }

  /// Call it after each step of the scenes. The first one after keep() has the new state.
  void advance(std::span<const pose::Pose* const> poses, std::span<const float> opacities, double dt_s) noexcept {
    if (left_s_ <= 0.0) return;
    if (is_kept_) {
      for (std::size_t i = 0; i < before_.size(); ++i) subtract(*poses[i], before_[i]);
      for (std::size_t i = 0; i < opacities.size(); ++i) before_opacities_[i] -= opacities[i];
      is_kept_ = false;
      return;
    }
    left_s_ -= dt_s;
  }

  bool is_settling() const noexcept { return left_s_ > 0.0; }

  /// Computes what is shown of these, which are the scenes' own: read it by the two below.
  void show(std::span<const pose::Pose* const> poses, std::span<const float> opacities) noexcept {
    const float part = is_kept_ ? 0.0F : part_left();
    for (std::size_t i = 0; i < shown_.size(); ++i) add(*poses[i], before_[i], part, shown_[i]);
    for (std::size_t i = 0; i < opacities.size(); ++i)
      shown_opacities_[i] = std::clamp(opacities[i] + part * before_opacities_[i], 0.0F, 1.0F);
  }
  std::span<const pose::Pose* const> poses() const noexcept { return pointers_; }
  std::span<const float> opacities() const noexcept { return shown_opacities_; }

 private:
  /// From 1 to 0, with a slope of 0 at both ends.
  float part_left() const noexcept {
    const double left = std::clamp(left_s_ / kSettling_s, 0.0, 1.0);
    return static_cast<float>(left * left * (3.0 - 2.0 * left));
  }

  static void copy(const pose::Pose& from, pose::Pose& to) noexcept { add(from, from, 0.0F, to); }
  /// before - now, into `before`.
  static void subtract(const pose::Pose& now, pose::Pose& before) noexcept {
    const pose::Arrays<const float> from(now);
    const pose::Arrays<float> into(before);
    for (std::size_t array = 0; array < into.size(); ++array) {
      for (std::size_t i = 0; i < into[array].size(); ++i) into[array][i] -= from[array][i];
    }
  }
  static void add(const pose::Pose& now, const pose::Pose& difference, float part, pose::Pose& sum) noexcept {
    const pose::Arrays<const float> from(now), besides(difference);
    const pose::Arrays<float> into(sum);
    for (std::size_t array = 0; array < into.size(); ++array) {
      for (std::size_t i = 0; i < into[array].size(); ++i) into[array][i] = from[array][i] + part * besides[array][i];
    }
  }

  std::vector<pose::Pose> before_;  ///< what was shown; from the first step on its difference to the new pose
  std::vector<float> before_opacities_;
  std::vector<pose::Pose> shown_;
  std::vector<const pose::Pose*> pointers_;
  std::vector<float> shown_opacities_;
  bool is_kept_ = false;  ///< the new state has not been stepped yet
  double left_s_ = 0.0;
};

}  // namespace yuragi::daemon::animation
