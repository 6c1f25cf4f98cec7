#pragma once

#include <memory>
#include <utility>

#include "daemon/settings/config.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi {

/// Set by a FailingScene for the thread that steps it. The test program's operator new throws std::bad_alloc then.
inline thread_local bool is_memory_gone = false;

/// Breaks its promise never to change its model, when there is no more memory: the frame, which has room for the model
/// that was there first, cannot be encoded.
class FailingScene final : public scenes::Scene {
 public:
  static constexpr int kGoodTicks = 20;

  FailingScene(const scenes::Scene& first, const scenes::Scene& larger)
      : skeleton_(first.skeleton()), pose_(first.pose()), larger_(larger.skeleton()), larger_pose_(larger.pose()) {}

  void shift(const wind::ground::Wind& /*wind*/, double /*dt_s*/) noexcept override {
    if (++ticks_ <= kGoodTicks) return;
    skeleton_ = std::move(larger_);
    pose_ = std::move(larger_pose_);
    is_memory_gone = true;
  }
  void sample() noexcept override {}
  void project(double /*dt_s*/) noexcept override {}
  const pose::Skeleton& skeleton() const noexcept override { return skeleton_; }
  double largest_joint_step_m(double /*dt_s*/) const noexcept override { return 0.0; }
  const pose::Pose& pose() const noexcept override { return pose_; }
  void list_state(StatePass& /*pass*/) override {}

 private:
  pose::Skeleton skeleton_;
  pose::Pose pose_;
  pose::Skeleton larger_;
  pose::Pose larger_pose_;
  int ticks_ = 0;
};

/// The default configuration, in which the meadow is a FailingScene.
inline daemon::settings::Config config_with_failing_scene() {
  static const scenes::Description* const kMeadow = daemon::settings::default_config().scenes.at(0).kind;
  static const scenes::Description kFailing{
      .name = kMeadow->name,
      .summary = kMeadow->summary,
      .parameters = kMeadow->parameters,
      .make = [](const ParameterValues& values, const scenes::Setup& setup) -> std::unique_ptr<scenes::Scene> {
        ParameterValues small = values;
        small.set("blades_across", std::int64_t{10});
        return std::make_unique<FailingScene>(*kMeadow->make(small, setup), *kMeadow->make(values, setup));
      }};
  daemon::settings::Config config = daemon::settings::default_config();
  config.scenes.at(0).kind = &kFailing;
  return config;
}

}  // namespace yuragi
