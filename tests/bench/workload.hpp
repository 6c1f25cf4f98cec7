#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "daemon/worker_pool.hpp"
#include "engine/pose/kinematics.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::bench {

inline constexpr double kBenchTick_s = 1.0 / 60.0;

/// A scene of the table, with its joints, in a steady breeze.
class Workload {
 public:
  static constexpr WindVector kBreeze = {6.0, 3.0};

  /// `kind` is in scene_table(); `given` are parameters that differ from the defaults. With gusts from outside the
  /// breeze has all octaves that a tile holds.
  Workload(std::string_view kind, const ParameterValues::Map& given, SimdRow row, bool has_gusts = false);

  std::size_t nodes() const { return nodes_; }
  Scene& scene() { return *scene_; }
  Kinematics& kinematics() { return *kinematics_; }

  // One frame's parts. Projection goes as far as joint positions.
  void shift() {
    if (gusts_) gusts_->carry(wind_.gusts.carried, kBreeze.u_m_s, -kBreeze.v_m_s, kBenchTick_s, kTurnover_m23_s);
    scene_->shift(wind_, kBenchTick_s);
  }
  void sample() { scene_->sample(); }
  void project() {
    scene_->project(kBenchTick_s);
    kinematics_->run(scene_->pose());
  }
  void frame() {
    shift();
    sample();
    project();
  }

  /// The same frame, shared out among the pool's threads.
  void frame(WorkerPool& pool);

  /// Stores 12 bytes a node into the same joints, and computes nothing.
  void store_only();

 private:
  static constexpr double kTurnover_m23_s = 0.3;

  std::shared_ptr<const GustNoise> gusts_;
  GroundWind wind_ = kBreeze;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<Kinematics> kinematics_;
  std::size_t nodes_ = 0;
  float value_ = 0.0F;
};

}  // namespace yuragi::bench
