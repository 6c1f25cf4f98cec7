// The viewer's own gusts over grass: they travel downwind at the wind's speed, and there are none in still air.

#include "viewer/meshes/meadow_waves.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace yuragi::viewer::meshes {
namespace {

std::vector<glm::vec2> bends_of(const MeadowWaves& waves) {
  std::vector<glm::vec2> bends(MeadowWaves::kNodes * MeadowWaves::kNodes);
  waves.fill(waves.mean_bend(), bends);
  return bends;
}

TEST(MeadowWaves, TravelDownwindAtTheWindsSpeed) {
  MeadowWaves waves;
  const glm::vec2 wind_m_s(6.0F, -2.5F);
  for (int tick = 0; tick <= 60; ++tick) waves.advance_to(5.0 + tick / 30.0, wind_m_s);
  EXPECT_NEAR(waves.drifted_m().x, 12.0F, 1e-3F);
  EXPECT_NEAR(waves.drifted_m().y, MeadowWaves::kSide_m - 5.0F, 1e-3F);
}

TEST(MeadowWaves, BendGrassDownwindByMoreInAGustAndNeverAgainstTheWind) {
  MeadowWaves waves;
  const glm::vec2 wind_m_s(0.0F, 7.0F);
  waves.advance_to(0.0, wind_m_s);
  float least = std::numeric_limits<float>::max();
  float most = 0.0F;
  for (const glm::vec2& bend : bends_of(waves)) {
    EXPECT_EQ(bend.x, 0.0F);
    least = std::min(least, bend.y);
    most = std::max(most, bend.y);
  }
  EXPECT_GT(least, 0.0F);
  EXPECT_GT(most, 2.0F * least);
  EXPECT_LT(most, 1.0F);
}

TEST(MeadowWaves, AreNotInStillAir) {
  MeadowWaves waves;
  waves.advance_to(0.0, {0.0F, 0.0F});
  for (const glm::vec2& bend : bends_of(waves)) EXPECT_EQ(bend, glm::vec2(0.0F));
}

TEST(MeadowWaves, StayAtTheSameMomentAndBeginAnewBackInTime) {
  MeadowWaves waves;
  waves.advance_to(1.0, {4.0F, 0.0F});
  waves.advance_to(1.5, {4.0F, 0.0F});
  const glm::vec2 there = waves.drifted_m();
  waves.advance_to(1.5, {9.0F, 3.0F});
  EXPECT_EQ(waves.drifted_m(), there);
  waves.advance_to(0.5, {4.0F, 0.0F});
  EXPECT_EQ(waves.drifted_m(), glm::vec2(0.0F));
}

}  // namespace
}  // namespace yuragi::viewer::meshes
