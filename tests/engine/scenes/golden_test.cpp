#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "engine/pose/kinematics.hpp"
#include "engine/pose/pose_hash.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/places.hpp"
#include "tests/support/scripted_wind.hpp"

// One hash per scene of what it does in 600 ticks under the scripted wind, with default parameters and seed 1: every
// pose, and the joint positions of every 20th. A change of the motion, however small, shows here; where it is meant,
// the new hash goes to tests/golden/<scene>.txt, and the CHANGELOG says that poses have changed.

namespace yuragi::scenes {
namespace {

std::string hash_of_600_ticks(Scene& scene, SimdRow row) {
  pose::Kinematics kinematics(scene.skeleton(), row);
  std::uint64_t hash = pose::kPoseHashSeed;
  for (std::uint64_t tick = 0; tick < 600; ++tick) {
    scene.tick(scripted_wind(tick), 1.0 / 60.0);
    hash = pose::pose_hash(hash, scene.pose());
    if (tick % 20 != 0) continue;
    EXPECT_TRUE(kinematics.run(scene.pose()));
    hash = kinematics.hash(hash);
  }
  std::ostringstream text;
  text << std::hex << hash;
  return text.str();
}

std::string golden_hash(std::string_view scene) {
  std::ifstream file(test::source_path("tests/golden/" + std::string(scene) + ".txt"));
  std::string hash;
  file >> hash;
  return hash;
}

ParameterValues defaults_of(const SceneDescription& scene) {
  return ParameterValues::resolve(scene.parameters, {}).value();
}

class GoldenOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(GoldenOnEachRow);

TEST_P(GoldenOnEachRow, EverySceneMovesAsItDidWhenItsHashWasWritten) {
  for (const SceneDescription* scene : scene_table()) {
    const auto made = scene->make(defaults_of(*scene), {.seed = 1, .row = GetParam()});
    EXPECT_EQ(hash_of_600_ticks(*made, GetParam()), golden_hash(scene->name)) << scene->name;
  }
}

}  // namespace
}  // namespace yuragi::scenes
