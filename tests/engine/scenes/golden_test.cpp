#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "engine/base/snapshot.hpp"
#include "engine/math/philox.hpp"
#include "engine/pose/kinematics.hpp"
#include "engine/pose/pose_hash.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/places.hpp"
#include "tests/support/scripted_wind.hpp"
#include "tests/support/station_wind.hpp"

// Hashes of what each scene does with default parameters and seed 1: every pose, and the joint positions of every 20th.
// In 600 ticks under the scripted wind, which is the same everywhere (tests/golden/<scene>.txt); and in 300 ticks of
// the wind that the estimator makes of a station's readings, with gusts over the ground
// (tests/golden/measured/<scene>.txt). A change of the motion, however small, shows here; where it is meant, the new
// hash goes to that file, and the CHANGELOG says that poses have changed.

namespace yuragi::scenes {
namespace {

constexpr double kGoldenTick_s = 1.0 / 60.0;

/// `wind_at(tick)`: what the scene is given.
template <class WindAt>
std::string hash_of(Scene& scene, SimdRow row, std::uint64_t ticks, WindAt wind_at) {
  pose::Kinematics kinematics(scene.skeleton(), row);
  std::uint64_t hash = pose::kPoseHashSeed;
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    scene.tick(wind_at(tick), kGoldenTick_s);
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

ParameterValues defaults_of(const Description& scene) {
  return ParameterValues::resolve(scene.parameters, {}).value();
}

class GoldenOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(GoldenOnEachRow);

TEST_P(GoldenOnEachRow, EverySceneMovesAsItDidWhenItsHashWasWritten) {
  for (const Description* scene : scene_table()) {
    const auto made = scene->make(defaults_of(*scene), {.seed = 1, .row = GetParam()});
    EXPECT_EQ(hash_of(*made, GetParam(), 600, scripted_wind), golden_hash(scene->name)) << scene->name;
  }
}

TEST_P(GoldenOnEachRow, EverySceneMovesInAMeasuredWindAsItDidWhenItsHashWasWritten) {
  for (const Description* scene : scene_table()) {
    const auto made = scene->make(defaults_of(*scene), {.seed = 1, .row = GetParam(), .gusts = station_gusts()});
    StationWind wind(GetParam());
    EXPECT_EQ(hash_of(*made, GetParam(), 300, [&](std::uint64_t tick) { return wind.at(tick); }),
              golden_hash("measured/" + std::string(scene->name)))
        << scene->name;
  }
}

/// A snapshot of another version of the motion is refused: so the version rises when a golden hash does, or what a
/// scene saves. tests/golden/motion.txt has the version and a hash of both.
TEST(MotionVersion, RisesWithEveryGoldenHashAndWithWhatSnapshotsHold) {
  std::string all;
  for (const Description* kind : scene_table()) {
    all += golden_hash(kind->name) + " " + golden_hash("measured/" + std::string(kind->name)) + " ";
    for (const auto& gusts : {std::shared_ptr<const wind::turbulence::GustNoise>(), station_gusts()}) {
      const auto scene = kind->make(defaults_of(*kind), {.seed = 1, .gusts = gusts});
      all += std::to_string(save_snapshot(*scene, 0).size()) + " ";
    }
  }
  std::ostringstream now;
  now << kMotionVersion << " " << std::hex << math::stream_id(all);
  std::ifstream file(test::source_path("tests/golden/motion.txt"));
  std::string written;
  std::getline(file, written);
  EXPECT_EQ(now.str(), written) << "raise kMotionVersion (engine/base/snapshot.hpp), then write the left to that file";
}

}  // namespace
}  // namespace yuragi::scenes
