#include "tests/answer/calm.hpp"

#include "engine/pose/pose_arrays.hpp"
#include "tests/answer/scene_run.hpp"

namespace yuragi::answer {

Figures calm_figures(const SceneTable& table, std::uint64_t seed) {
  constexpr int kTicks = 120;
  if (!described(table.scene).is_still_in_calm) return {};
  const std::unique_ptr<scenes::Scene> scene = make_scene(table, seed);
  for (int tick = 0; tick < kTicks; ++tick) scene->tick(wind::Vector{}, kTick_s);

  const pose::Pose rest = pose::rest_pose(scene->skeleton());
  const pose::Arrays<const float> is(scene->pose());
  const pose::Arrays<const float> was(rest);
  std::size_t moved = 0;
  for (std::size_t array = 0; array < is.size(); ++array) {
    for (std::size_t i = 0; i < is[array].size(); ++i) moved += is[array][i] == was[array][i] ? 0U : 1U;
  }
  return {{"in calm: numbers off the rest pose", static_cast<double>(moved)}};
}

}  // namespace yuragi::answer
