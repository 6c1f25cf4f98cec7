#include "viewer/light/light.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "viewer/light/daylight.hpp"
#include "viewer/light/palettes.hpp"
#include "viewer/light/sky_keeper.hpp"

namespace yuragi::viewer::light {
namespace {

constexpr double kDay_s = 1'790'208'000.0;

float sum(const glm::vec4& light) {
  return light.r + light.g + light.b;
}

TEST(Daylight, GrowsWithTheSunsHeight) {
  for (int quarter = -4; quarter < 360; ++quarter) {
    const double height_deg = 0.25 * quarter;
    const glm::vec3 low = sunlight_at(height_deg);
    const glm::vec3 high = sunlight_at(height_deg + 0.25);
    for (int channel = 0; channel < 3; ++channel) ASSERT_GE(high[channel], low[channel]) << height_deg;
  }
  for (int quarter = -120; quarter < 360; ++quarter) {
    const double height_deg = 0.25 * quarter;
    const float low = sum(daylight({.sun = {height_deg, 200.0}}).sky_light);
    const float high = sum(daylight({.sun = {height_deg + 0.25, 200.0}}).sky_light);
    ASSERT_GE(high, low) << height_deg;
    ASSERT_LT(high, 1.25F * low) << "steps at " << height_deg;
  }
}

TEST(Daylight, IsRedderTheLowerTheSunIs) {
  const auto redness = [](double height_deg) { return sunlight_at(height_deg).r / sunlight_at(height_deg).b; };
  EXPECT_GT(redness(2.0), redness(8.5));
  EXPECT_GT(redness(8.5), redness(60.0));
  // The evening of the first pictures.
  EXPECT_NEAR(sunlight_at(8.5).r, 3.9F, 0.2F);
  EXPECT_NEAR(sunlight_at(8.5).g, 2.55F, 0.2F);
  EXPECT_NEAR(sunlight_at(8.5).b, 1.30F, 0.2F);
}

TEST(Daylight, HasNoSunUnderAnOvercastSky) {
  const Sky clear{.sun = {50.0, 180.0}};
  Sky overcast = clear;
  overcast.clouds = 1.0;
  EXPECT_LT(sum(daylight(overcast).sun_light), 0.05F * sum(daylight(clear).sun_light));
  const glm::vec4 zenith = daylight(overcast).zenith;
  EXPECT_LT(zenith.b / zenith.r, 1.3F) << "grey";
  EXPECT_GT(sum(daylight(overcast).sky_light), sum(daylight(clear).sky_light)) << "it spreads the sun's light";
}

TEST(Daylight, IsTheMoonsByNight) {
  const Sky night{.sun = {-40.0, 0.0}, .moon = {40.0, 150.0}, .moon_lit_share = 1.0};
  const Light light = daylight(night);
  EXPECT_GT(sum(light.sun_light), 0.0F);
  EXPECT_NEAR(glm::dot(glm::dvec3(glm::vec3(light.to_sun)), direction_of(night.moon)), 1.0, 1e-5);
  EXPECT_GT(light.air.w, 0.0F) << "stars";
  EXPECT_EQ(sum(daylight({.sun = {-40.0, 0.0}}).sun_light), 0.0F) << "no moon";
}

TEST(Daylight, LosesItsColorsInTheDark) {
  EXPECT_EQ(daylight({.sun = {20.0, 200.0}}).colors.y, 1.0F);
  EXPECT_LT(daylight({.sun = {-20.0, 200.0}}).colors.y, 0.7F);
}

TEST(Daylight, HasNoCloudsWhereNoneAreAsked) {
  // The noise that clouds are made of goes from 0 to 1.
  EXPECT_GE(daylight({.sun = {20.0, 200.0}, .clouds = 0.0}).air.z, 1.0F);
  EXPECT_LE(daylight({.sun = {20.0, 200.0}, .clouds = 1.0}).air.z, 0.0F);
  for (double clouds = 0.0; clouds < 0.995; clouds += 0.01) {
    ASSERT_GT(daylight({.clouds = clouds}).air.z, daylight({.clouds = clouds + 0.01}).air.z) << clouds;
  }
}

TEST(Daylight, HasShadowsOfCloudsByDayWhereSingleCloudsAreInTheSky) {
  const Sky day{.sun = {40.0, 180.0}, .clouds = 0.3, .haze = 0.15};
  const auto changed = [&](auto&& change) {
    Sky sky = day;
    change(sky);
    return daylight(sky).drift;
  };
  EXPECT_GT(daylight(day).drift.z, 0.3F);
  EXPECT_EQ(changed([](Sky& sky) { sky.sun.height_deg = -1.0; }).z, 0.0F) << "by night";
  EXPECT_EQ(changed([](Sky& sky) { sky.clouds = 1.0; }).z, 0.0F) << "overcast";
  EXPECT_EQ(changed([](Sky& sky) { sky.haze = 1.0; }).z, 0.0F) << "fog";
  // The noise goes from 0 to 1.
  EXPECT_GE(changed([](Sky& sky) { sky.clouds = 0.0; }).w, 1.0F) << "no cloud, no shadow";
  EXPECT_LT(changed([](Sky& sky) { sky.clouds = 0.5; }).w, daylight(day).drift.w) << "more of them";
}

TEST(SkyKeeper, FadesShadowsOfCloudsAndLetsThemDriftOn) {
  SkyKeeper keeper;
  keeper.start({.clouds = 0.3});
  const Light before = keeper.advance(kDay_s, 0.0, {4.0, 0.0});
  keeper.set_look({.clouds = 1.0});
  const Light between = keeper.advance(kDay_s, 0.5 * SkyKeeper::kFade_s, {4.0, 0.0});
  EXPECT_LT(between.drift.z, before.drift.z);
  EXPECT_GT(between.drift.z, 0.0F);
  EXPECT_GT(between.drift.x, before.drift.x);
}

TEST(Palettes, AreAllOfColorsThatThingsCanHave) {
  for (int palette = 0; palette <= static_cast<int>(look::Palette::kInk); ++palette) {
    for (int ground = 0; ground <= static_cast<int>(look::GroundKind::kSnow); ++ground) {
      Light light;
      set_colors({.palette = static_cast<look::Palette>(palette), .ground = static_cast<look::GroundKind>(ground)},
                 light);
      for (const glm::vec4& color : {light.grass_lush, light.grass_fresh, light.grass_straw, light.grass_foot,
                                     light.petals[0], light.petals[1], light.petals[2], light.earth}) {
        for (int channel = 0; channel < 3; ++channel) {
          EXPECT_GT(color[channel], 0.0F) << palette << ground;
          EXPECT_LT(color[channel], 0.95F) << palette << ground;
        }
      }
      EXPECT_LT(sum(light.grass_foot), sum(light.grass_fresh)) << "it is in the shade of its neighbours";
      EXPECT_EQ(light.colors.z == 1.0F, ground == 0) << "only in a meadow grass is tall";
    }
  }
}

TEST(Palettes, LeavesFallInAutumnAndNoneHangInWinter) {
  const auto hanging = [](look::Palette palette) { return light_of({.palette = palette}, 0.0).leaves.w; };
  EXPECT_EQ(hanging(look::Palette::kMeadow), 1.0F);
  EXPECT_LT(hanging(look::Palette::kAutumn), 0.9F);
  EXPECT_GT(hanging(look::Palette::kAutumn), 0.5F);
  EXPECT_EQ(hanging(look::Palette::kWinter), 0.0F);
  const Light autumn = light_of({.palette = look::Palette::kAutumn}, 0.0);
  EXPECT_GT(autumn.turned_leaves.r, 1.5F * autumn.leaves.r) << "not all turn as far";
}

TEST(Palettes, InkHasHardlyAnyColor) {
  EXPECT_LT(light_of({.palette = look::Palette::kInk}, kDay_s).colors.x, 0.1F);
  EXPECT_EQ(light_of({}, kDay_s).colors.x, 1.0F);
}

TEST(SkyKeeper, FadesFromOnePaletteToAnother) {
  SkyKeeper keeper;
  keeper.start({});
  const Light meadow = keeper.advance(kDay_s, 0.0, {});
  keeper.set_look({.palette = look::Palette::kAutumn, .ground = look::GroundKind::kSand});
  const Light between = keeper.advance(kDay_s, 0.5 * SkyKeeper::kFade_s, {});
  const Light autumn = keeper.advance(kDay_s, SkyKeeper::kFade_s, {});
  for (glm::vec4 Light::*const part : {&Light::grass_lush, &Light::leaves, &Light::woods, &Light::earth}) {
    EXPECT_NEAR((between.*part).r, 0.5F * ((meadow.*part).r + (autumn.*part).r), 0.01F);
    EXPECT_NE((meadow.*part).r, (autumn.*part).r);
  }
  EXPECT_NEAR(between.petals[1].g, 0.5F * (meadow.petals[1].g + autumn.petals[1].g), 0.01F);
  EXPECT_NEAR(between.colors.z, 0.5F, 0.01F) << "grass sinks into the ground";
}

TEST(SkyKeeper, BeginsWithTheLookAtOnce) {
  SkyKeeper keeper;
  keeper.start({.sun = look::SunChoice::kTime, .solar_time_h = 12.0});
  const Light light = keeper.advance(kDay_s, 0.0, {});
  EXPECT_GT(light.to_sun.y, 0.7F) << "it is highest at noon";
  EXPECT_GT(light.to_sun.z, 0.0F) << "in the south";
  EXPECT_NEAR(light.to_sun.x, 0.0F, 0.01F);
}

TEST(SkyKeeper, FollowsADayWithoutAJump) {
  SkyKeeper keeper;
  keeper.start({.sun = look::SunChoice::kTime, .clouds = 0.0});
  Light before = keeper.advance(kDay_s, 0.0, {});
  for (int passed_s = 1; passed_s < 86400; ++passed_s) {
    const Light now = keeper.advance(kDay_s + passed_s, 1.0, {});
    ASSERT_NEAR(std::log(now.air.x / before.air.x), 0.0, 0.02) << "exposure after " << passed_s << " s";
    ASSERT_NEAR(sum(now.zenith), sum(before.zenith), 0.01F * sum(before.zenith) + 1e-6F) << passed_s;
    // Sun and moon change places while neither shines.
    const float turn = glm::distance(glm::vec3(now.to_sun), glm::vec3(before.to_sun));
    ASSERT_LT(turn * std::max(sum(now.sun_light), sum(before.sun_light)), 0.01F) << passed_s;
    before = now;
  }
}

TEST(SkyKeeper, FadesToAnotherLookWithoutAJump) {
  SkyKeeper keeper;
  keeper.start({.sun = look::SunChoice::kFixed, .sun_height_deg = 20.0, .sun_azimuth_deg = 90.0});
  Light before = keeper.advance(kDay_s, 0.0, {});
  keeper.set_look({.sun = look::SunChoice::kFixed, .sun_height_deg = 20.0, .sun_azimuth_deg = 270.0, .clouds = 0.9});
  constexpr double kStep_s = 1.0 / 60.0;
  for (int step = 0; kStep_s * step < SkyKeeper::kFade_s + 1.0; ++step) {
    const double passed_s = kStep_s * step;
    const Light now = keeper.advance(kDay_s, kStep_s, {});
    ASSERT_NEAR(now.air.x, before.air.x, 0.03F * before.air.x) << passed_s;
    ASSERT_NEAR(sum(now.sky_light), sum(before.sky_light), 0.02F * sum(before.sky_light)) << passed_s;
    const float turn = glm::distance(glm::vec3(now.to_sun), glm::vec3(before.to_sun));
    ASSERT_LT(turn * sum(now.sun_light), 0.5F) << "a shadow swings after " << passed_s << " s";
    before = now;
  }
  EXPECT_LT(before.to_sun.x, -0.5F) << "it has arrived";
}

TEST(SkyKeeper, FollowsASliderThatIsDraggedWhileItIsDragged) {
  SkyKeeper keeper;
  keeper.start({.clouds = 0.0});
  const float at_first = keeper.advance(kDay_s, 0.0, {}).air.x;
  look::Look look{.clouds = 0.0};
  // Three seconds with another exposure ten times a second, at 60 pictures a second.
  for (int picture = 0; picture < 180; ++picture) {
    if (picture % 6 == 0) look.exposure_ev += 1.0 / 30.0;
    keeper.set_look(look, 0.3);
    const float before = keeper.light().air.x;
    const float now = keeper.advance(kDay_s, 1.0 / 60.0, {}).air.x;
    ASSERT_NEAR(std::log2(now / before), 0.0F, 0.03F) << picture;
  }
  EXPECT_GT(keeper.light().air.x, 1.8F * at_first) << "nearly a doubling already";
}

TEST(SkyKeeper, LetsCloudsDriftWithTheWindAndNotTooFast) {
  SkyKeeper keeper;
  keeper.start({});
  keeper.advance(kDay_s, 0.0, {4.0, -2.0});
  const Light light = keeper.advance(kDay_s, 5.0, {4.0, -2.0});
  EXPECT_GT(light.drift.x, 0.0F);
  SkyKeeper stormy;
  stormy.start({});
  stormy.advance(kDay_s, 0.0, {1e6, 0.0});
  EXPECT_LT(stormy.advance(kDay_s, 1.0, {1e6, 0.0}).drift.x, 0.05F);
}

TEST(SkyKeeper, TakesTheExposureAsAsked) {
  const Light plain = light_of({}, kDay_s);
  const Light bright = light_of({.exposure_ev = 1.0}, kDay_s);
  EXPECT_NEAR(bright.air.x, 2.0F * plain.air.x, 1e-5F);
}

}  // namespace
}  // namespace yuragi::viewer::light
