#include "tests/answer/scene_run.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace yuragi::answer {
namespace {

std::size_t ticks_in(double seconds) {
  return static_cast<std::size_t>(std::llround(seconds * kRate_hz));
}

}  // namespace

const scenes::Description& described(std::string_view name) {
  for (const scenes::Description* scene : scenes::scene_table()) {
    if (scene->name == name) return *scene;
  }
  throw std::invalid_argument("no scene is called " + std::string(name));
}

std::unique_ptr<scenes::Scene> make_scene(const SceneTable& table, std::uint64_t seed) {
  const scenes::Description& scene = described(table.scene);
  return scene.make(ParameterValues::resolve(scene.parameters, table.parameters).value(),
                    {.seed = seed, .gusts = test_gusts()});
}

RecordLength usual_length(std::size_t beaufort_index) {
  return {.record_s = kBeaufort[beaufort_index] < 2 ? 600.0 : 300.0};
}

TestWind record_wind(std::size_t beaufort_index, const WindChoice& choice) {
  return TestWind(test_gusts(), {.speed_m_s = choice.speed * kMeanSpeed_m_s[beaufort_index],
                                 .intensity = choice.intensity,
                                 .seed = wind_seed(beaufort_index) + choice.seed - 1});
}

SceneRecord record_scene(const SceneTable& table, std::size_t beaufort_index, const RecordLength& length,
                         const WindChoice& choice) {
  const std::unique_ptr<scenes::Scene> scene = make_scene(table, choice.seed);
  const std::unique_ptr<Meter> meter = table.make_meter(scene->skeleton());
  pose::Kinematics joints(scene->skeleton());
  TestWind wind = record_wind(beaufort_index, choice);
  for (std::size_t tick = 0; tick < ticks_in(length.start_s); ++tick) scene->tick(wind.step(kTick_s), kTick_s);

  WindRecord record;
  for (std::size_t tick = 0; tick < ticks_in(length.record_s); ++tick) {
    scene->tick(wind.step(kTick_s), kTick_s);
    record.take(wind.at_origin());
    if (meter->needs_joints(tick)) joints.run(scene->pose());
    meter->take(tick, scene->pose(), joints);
  }

  SceneRecord result{.figures = meter->figures(record), .traces = meter->traces(record)};
  result.figures.push_back(
      {"wind, mean / U", record.mean_speed_m_s() / (choice.speed * kMeanSpeed_m_s[beaufort_index])});
  result.figures.push_back({"wind, intensity / 0.2", record.intensity() / choice.intensity});
  result.figures.push_back(
      {"largest step of a joint / its bound", meter->largest_step_m() / scene->largest_joint_step_m(kTick_s)});
  result.traces.insert(result.traces.begin(), {"wind", "m/s", record.speed_m_s()});
  return result;
}

}  // namespace yuragi::answer
