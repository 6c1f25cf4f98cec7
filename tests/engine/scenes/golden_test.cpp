#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "engine/pose/kinematics.hpp"
#include "engine/pose/pose_hash.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/wind/blend/blended_estimator.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/places.hpp"
#include "tests/support/scripted_wind.hpp"

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

const std::shared_ptr<const wind::turbulence::GustNoise>& golden_gusts() {
  static const auto kGusts = std::make_shared<const wind::turbulence::GustNoise>(
      wind::turbulence::GustNoiseSettings{.samples = 128, .seed = 3, .evolves = true});
  return kGusts;
}

/// The wind of a station that reads the scripted wind once a second, as the daemon makes it.
class StationWind {
 public:
  explicit StationWind(SimdRow row) : estimator_(1, settings(), golden_gusts()), tapes_(1, row) {}

  wind::ground::Wind at(std::uint64_t tick) {
    const MonoTime now(from_seconds(static_cast<double>(tick) * kGoldenTick_s));
    if (tick % 60 == 0) {
      const wind::Vector wind = scripted_wind(tick);
      wind::Reading reading;
      reading.speed_m_s = wind::speed_of(wind);
      reading.direction_deg = wind::direction_from_deg(wind);
      reading.time.mono = now;
      estimator_.accept(0, reading);
    }
    wind::ground::DrivingWind driving;
    driving.state = estimator_.advance(now);
    driving.ground = estimator_.ground();
    driving.stroke = estimator_.stroke();
    driving.ground.tick = tick;
    return written_to(tapes_, driving);
  }

 private:
  static wind::blend::Settings settings() {
    wind::blend::Settings settings;
    settings.gustiness = 0.3;
    settings.reach_m = 10.0;
    return settings;
  }

  wind::blend::BlendedEstimator estimator_;
  wind::ground::WindTapes tapes_;
};

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
    const auto made = scene->make(defaults_of(*scene), {.seed = 1, .row = GetParam(), .gusts = golden_gusts()});
    StationWind wind(GetParam());
    EXPECT_EQ(hash_of(*made, GetParam(), 300, [&](std::uint64_t tick) { return wind.at(tick); }),
              golden_hash("measured/" + std::string(scene->name)))
        << scene->name;
  }
}

}  // namespace
}  // namespace yuragi::scenes
