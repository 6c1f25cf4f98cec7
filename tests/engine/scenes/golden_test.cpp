#include <cstdlib>
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
// (tests/golden/measured/<scene>.txt). A file has the hash after a quarter of the ticks and that after all. A change of
// the motion, however small, shows here; where it is meant, the new hashes go to that file, and the CHANGELOG says that
// poses have changed.

namespace yuragi::scenes {
namespace {

constexpr double kGoldenTick_s = 1.0 / 60.0;

/// After a quarter of the ticks, and after all.
struct Hashes {
  std::string quarter, whole;
};

Hashes golden_hashes(std::string_view scene) {
  std::ifstream file(test::source_path("tests/golden/" + std::string(scene) + ".txt"));
  Hashes hashes;
  file >> hashes.quarter >> hashes.whole;
  return hashes;
}

/// An emulated processor computes the first quarter alone.
bool is_quarter_enough() {
  return std::getenv("YURAGI_GOLDEN_QUARTER") != nullptr;  // NOLINT(concurrency-mt-unsafe): nobody changes it
}

/// `wind_at(tick)`: what the scene is given. `golden`: the name of its hashes.
template <class WindAt>
void expect_golden(Scene& scene, SimdRow row, std::uint64_t ticks, const std::string& golden, WindAt wind_at) {
  const auto text_of = [](std::uint64_t hash) {
    std::ostringstream text;
    text << std::hex << hash;
    return text.str();
  };
  pose::Kinematics kinematics(scene.skeleton(), row);
  const Hashes expected = golden_hashes(golden);
  std::uint64_t hash = pose::kPoseHashSeed;
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    scene.tick(wind_at(tick), kGoldenTick_s);
    hash = pose::pose_hash(hash, scene.pose());
    if (tick % 20 == 0) {
      EXPECT_TRUE(kinematics.run(scene.pose()));
      hash = kinematics.hash(hash);
    }
    if (tick + 1 != ticks / 4) continue;
    EXPECT_EQ(text_of(hash), expected.quarter) << golden << ", after a quarter of its ticks";
    if (is_quarter_enough()) return;
  }
  EXPECT_EQ(text_of(hash), expected.whole) << golden;
}

ParameterValues defaults_of(const Description& scene) {
  return ParameterValues::resolve(scene.parameters, {}).value();
}

class GoldenOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(GoldenOnEachRow);

TEST_P(GoldenOnEachRow, EverySceneMovesAsItDidWhenItsHashWasWritten) {
  for (const Description* scene : scene_table()) {
    const auto made = scene->make(defaults_of(*scene), {.seed = 1, .row = GetParam()});
    expect_golden(*made, GetParam(), 600, std::string(scene->name), scripted_wind);
  }
}

TEST_P(GoldenOnEachRow, EverySceneMovesInAMeasuredWindAsItDidWhenItsHashWasWritten) {
  for (const Description* scene : scene_table()) {
    const auto made = scene->make(defaults_of(*scene), {.seed = 1, .row = GetParam(), .gusts = station_gusts()});
    StationWind wind(GetParam());
    expect_golden(*made, GetParam(), 300, "measured/" + std::string(scene->name),
                  [&](std::uint64_t tick) { return wind.at(tick); });
  }
}

/// A snapshot of another version of the motion is refused: so the version rises when a golden hash does, or what a
/// scene saves. tests/golden/motion.txt has the version and a hash of both.
TEST(MotionVersion, RisesWithEveryGoldenHashAndWithWhatSnapshotsHold) {
  std::string all;
  for (const Description* kind : scene_table()) {
    all += golden_hashes(kind->name).whole + " " + golden_hashes("measured/" + std::string(kind->name)).whole + " ";
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
