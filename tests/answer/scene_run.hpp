#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "engine/pose/kinematics.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/answer/scene_table.hpp"
#include "tests/answer/test_wind.hpp"
#include "tests/answer/wind_record.hpp"

namespace yuragi::answer {

/// The scene that scene_table() has under this name. Throws std::invalid_argument without one.
const scenes::Description& described(std::string_view name);

/// The scene of a table, made as the daemon makes it, with the gusts of the wind that it will be given.
std::unique_ptr<scenes::Scene> make_scene(const SceneTable& table, std::uint64_t seed);

/// How long a record takes, after how long a start.
struct RecordLength {
  double start_s = 30.0;
  double record_s = 300.0;
};
/// Of a Beaufort number: in a light wind twice as long, for its gusts pass as slowly.
RecordLength usual_length(std::size_t beaufort_index);

/// What a record has shown.
struct SceneRecord {
  Figures figures;
  std::vector<Trace> traces;  ///< the wind's speed first
};

/// How the wind differs from the test wind of a Beaufort number.
struct WindChoice {
  double speed = 1.0;  ///< times the number's mean
  double intensity = 0.2;
  std::uint64_t seed = 1;  ///< above 1: another stretch of the noise, and another model of the scene
};

/// The wind of a record, from the beginning of its start.
TestWind record_wind(std::size_t beaufort_index, const WindChoice& choice);

/// Records a scene in the test wind of a Beaufort number, and looks at it.
SceneRecord record_scene(const SceneTable& table, std::size_t beaufort_index, const RecordLength& length,
                         const WindChoice& choice);

}  // namespace yuragi::answer
