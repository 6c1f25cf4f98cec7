#include "viewer/light/fire_light.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::viewer::light {
namespace {

TEST(NearestFires, AreThoseNextToTheEyeAndNoMoreThanThereIsRoomFor) {
  std::vector<Fire> fires;
  for (int i = 0; i < 6; ++i) {
    fires.push_back(
        {.place_m = {10.0F - static_cast<float>(i), 0.0F, 0.0F}, .light = glm::vec3(static_cast<float>(i))});
  }
  const Fires nearest = nearest_fires(fires, glm::vec3(0.0F));
  EXPECT_EQ(nearest.count.x, 4.0F);
  for (std::size_t i = 0; i < Fires::kMost; ++i) EXPECT_EQ(nearest.light[i].r, 5.0F - static_cast<float>(i));
  EXPECT_EQ(nearest_fires({}, glm::vec3(0.0F)).count.x, 0.0F);
}

TEST(NearestFires, HasTwoAtTheSameDistanceToo) {
  const std::vector<Fire> fires{{.place_m = {1, 0, 0}, .light = {1, 0, 0}},
                                {.place_m = {-1, 0, 0}, .light = {0, 1, 0}}};
  const Fires nearest = nearest_fires(fires, glm::vec3(0.0F));
  EXPECT_EQ(nearest.count.x, 2.0F);
  EXPECT_EQ(nearest.light[0].r + nearest.light[1].r, 1.0F);
  EXPECT_EQ(nearest.light[0].g + nearest.light[1].g, 1.0F);
}

TEST(FlameBrightness, IsLessInALongerExposureButTheFlameIsBrighterOnTheScreen) {
  EXPECT_FLOAT_EQ(flame_brightness(1.0F), 1.0F);
  EXPECT_LT(flame_brightness(20.0F), 0.3F);
  EXPECT_GT(20.0F * flame_brightness(20.0F), 1.5F);
  EXPECT_TRUE(std::isfinite(flame_brightness(0.0F)));
}

/// The screen's relative luminance of a light: as finish() in common.glsl, before the transfer curve.
double on_screen(double light) {
  return light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
}

TEST(FireFlicker, NeverFlashesMoreThanThreeTimesInASecondHoweverItsHeatJumps) {
  for (const double flicker_hz : {1.0, 2.0, 3.0, 5.0, 8.0, 15.0}) {
    for (const double exposure : {0.05, 0.2, 0.5, 1.0, 2.0, 5.0}) {
      FireFlicker flicker;
      std::vector<double> luminance;
      for (int i = 0; i < 300; ++i) {
        const double time_s = i / 60.0;
        const bool is_hot = std::fmod(time_s * flicker_hz, 1.0) < 0.5;
        luminance.push_back(on_screen(exposure * static_cast<double>(flicker.follow(is_hot ? 1.0F : 0.05F, time_s))));
      }
      // All that it goes up and down in any second is less than seven changes of 0.0625.
      for (std::size_t from = 0; from + 60 < luminance.size(); ++from) {
        double way = 0.0;
        for (std::size_t i = from; i < from + 60; ++i) way += std::abs(luminance[i + 1] - luminance[i]);
        ASSERT_LT(way, 0.4375) << flicker_hz << " Hz, exposure " << exposure;
      }
    }
  }
}

TEST(FireFlicker, FollowsSlowChangesAndTakesAJumpInTimeAsItIs) {
  FireFlicker flicker;
  EXPECT_NEAR(flicker.follow(0.5F, 10.0), 0.5F, 1e-6F);
  EXPECT_LT(flicker.follow(1.0F, 10.0 + 1.0 / 60.0), 0.52F);
  EXPECT_NEAR(flicker.follow(1.0F, 11.0), 1.0F, 1e-5F);
  EXPECT_NEAR(flicker.follow(0.2F, 100.0), 0.2F, 1e-6F);
  EXPECT_EQ(flicker.follow(0.0F, 200.0), 0.0F);
}

}  // namespace
}  // namespace yuragi::viewer::light
