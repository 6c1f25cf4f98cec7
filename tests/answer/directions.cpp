#include "tests/answer/directions.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/units.hpp"
#include "tests/answer/scene_run.hpp"

namespace yuragi::answer {
namespace {

constexpr int kDirections = 8;
constexpr int kTurnStartTicks = 600;
constexpr int kTurnRecordTicks = 1200;
/// Joints are computed, and the direction taken, at every so many ticks.
constexpr int kEvery = 12;

/// The angle between downwind and the scene's direction, degrees; 0 where the wind is mostly what it does not give way
/// to.
double turn_deg(const SceneTable& table, std::size_t beaufort_index, double direction_deg, std::uint64_t seed) {
  const std::unique_ptr<scenes::Scene> scene = make_scene(table, seed);
  const std::unique_ptr<Meter> meter = table.make_meter(scene->skeleton());
  pose::Kinematics joints(scene->skeleton());
  TestWind wind(test_gusts(), {.speed_m_s = kMeanSpeed_m_s[beaufort_index],
                               .direction_deg = direction_deg,
                               .seed = wind_seed(beaufort_index) + seed - 1});
  Horizontal pointed, blown;
  for (int tick = 0; tick < kTurnStartTicks + kTurnRecordTicks; ++tick) {
    scene->tick(wind.step(kTick_s), kTick_s);
    if (tick < kTurnStartTicks || tick % kEvery != 0) continue;
    joints.run(scene->pose());
    const Horizontal way = meter->direction(scene->pose(), joints);
    pointed = {pointed.east + way.east, pointed.south + way.south};
    const wind::Vector air = wind.at_origin();
    blown = {blown.east + air.u_m_s, blown.south - air.v_m_s};
  }
  const double all = blown.length();
  blown.east *= table.gives_way_along_east;
  if (blown.length() < 0.5 * all) return 0.0;
  const double along = pointed.dot(blown);
  const double across = pointed.dot(blown.aside());
  return std::abs(std::atan2(across, along)) / kRadPerDeg;
}

}  // namespace

Figures turn_figures(const SceneTable& table, std::size_t beaufort_index, std::uint64_t seed) {
  if (beaufort_index == 0 || table.largest_turn_deg == 0.0) return {};
  double largest_deg = 0.0;
  for (int i = 0; i < kDirections; ++i) {
    const double direction_deg = 360.0 * static_cast<double>(i) / static_cast<double>(kDirections);
    largest_deg = std::max(largest_deg, turn_deg(table, beaufort_index, direction_deg, seed));
  }
  return {{"from downwind, at most of 8 directions", largest_deg}};
}

}  // namespace yuragi::answer
