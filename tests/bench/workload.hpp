#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "engine/pose/kinematics.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/workers/worker_pool.hpp"
#include "tests/bench/bench_wind.hpp"

namespace yuragi::bench {

/// A scene of a workload.
struct BenchScene {
  const scenes::Description* kind = nullptr;
  ParameterValues values;
  std::uint64_t seed = 1;
  scenes::Placement placement = {};
  double gain = 1.0;
};

/// The scene that scene_table() has under `kind`, in the middle; `given` are parameters that differ from the defaults.
BenchScene bench_scene(std::string_view kind, const ParameterValues::Map& given = {});

/// Those that a configuration shows.
std::vector<BenchScene> scenes_of(const std::filesystem::path& config_file);

/// Scenes of a row of the table, with their joints.
class Workload {
 public:
  /// With `gusts` from outside, or with what noise a scene has of its own.
  Workload(const std::vector<BenchScene>& scenes, SimdRow row,
           std::shared_ptr<const wind::turbulence::GustNoise> gusts = nullptr);

  std::size_t nodes() const { return nodes_; }
  const pose::Skeleton& first_skeleton() const { return parts_.front().scene->skeleton(); }

  // One frame's parts. Projection goes as far as joint positions.
  void shift();
  void sample();
  void project();
  void frame() {
    shift();
    sample();
    project();
  }

  /// The same frame, shared out among the pool's threads.
  void frame(workers::Pool& pool);

  // Store 12 bytes a node into the same joints, and compute nothing: in a plain loop, by memset, and past the caches.
  void store_in_a_loop();
  void store_by_memset();
  void store_past_caches();

 private:
  struct Placed {
    std::unique_ptr<scenes::Scene> scene;
    std::unique_ptr<pose::Kinematics> kinematics;
    double gain = 1.0;
  };

  BenchWind wind_;
  std::vector<Placed> parts_;
  std::vector<std::span<float>> joints_;
  std::size_t nodes_ = 0;
  float value_ = 0.0F;
};

}  // namespace yuragi::bench
