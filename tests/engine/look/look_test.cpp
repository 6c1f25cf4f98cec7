#include "engine/look/look.hpp"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/look/time_of_day.hpp"

namespace yuragi::look {
namespace {

Result<Look, ParameterError> from(const ParameterValues::Map& given) {
  const auto values = ParameterValues::resolve(look_parameters(), given);
  if (!values) return values.error();
  return look_of(*values);
}

Result<Look, ParameterError> from_text(const std::vector<std::string>& edits, const Look& look = {}) {
  return edited(look, edits);
}

TEST(TimeOfDay, ReadsHoursAndMinutes) {
  EXPECT_EQ(time_of_day_h("06:30"), 6.5);
  EXPECT_EQ(time_of_day_h("00:00"), 0.0);
  EXPECT_EQ(time_of_day_h("24:00"), 24.0);
}

TEST(TimeOfDay, RefusesEverythingElse) {
  for (const char* text : {"", "6:30", "06:3", "24:01", "25:00", "06:60", "06.30", "-6:30", "06:30 ", "ab:cd"}) {
    EXPECT_FALSE(time_of_day_h(text)) << text;
  }
}

TEST(Look, IsTheEveningWithoutSettings) {
  const auto look = from({});
  ASSERT_TRUE(look);
  EXPECT_EQ(*look, Look{});
  EXPECT_EQ(look->sun, SunChoice::kEvening);
}

TEST(Look, TakesEveryValue) {
  const auto look = from({{"sun", std::string("time")},
                          {"latitude", -33.9},
                          {"longitude", 18.4},
                          {"time", std::string("06:30")},
                          {"sun_height", 12.0},
                          {"sun_azimuth", 80.0},
                          {"clouds", 1.0},
                          {"haze", std::int64_t{0}},
                          {"exposure", -1.5},
                          {"quality", std::string("medium")},
                          {"palette", std::string("summer-dry")},
                          {"ground", std::string("stone")},
                          {"ground_image", std::string("tatami.jpg")},
                          {"ground_image_width", 1.8},
                          {"density", 0.5}});
  ASSERT_TRUE(look);
  EXPECT_EQ(*look, (Look{.sun = SunChoice::kTime,
                         .latitude_deg = -33.9,
                         .longitude_deg = 18.4,
                         .solar_time_h = 6.5,
                         .sun_height_deg = 12.0,
                         .sun_azimuth_deg = 80.0,
                         .clouds = 1.0,
                         .haze = 0.0,
                         .exposure_ev = -1.5,
                         .quality = Quality::kMedium,
                         .palette = Palette::kSummerDry,
                         .ground = GroundKind::kStone,
                         .ground_image_width_m = 1.8,
                         .density = 0.5}));
}

TEST(Look, KnowsTheSunByWhatElseIsGiven) {
  EXPECT_EQ(from({{"latitude", 52.5}})->sun, SunChoice::kTime);
  EXPECT_EQ(from({{"time", std::string("now")}})->sun, SunChoice::kTime);
  EXPECT_EQ(from({{"sun_height", 5.0}})->sun, SunChoice::kFixed);
  EXPECT_EQ(from({{"sun", std::string("evening")}, {"time", std::string("12:00")}})->sun, SunChoice::kEvening);
}

TEST(Look, RefusesMistakesByName) {
  EXPECT_EQ(from({{"time", std::string("noon")}}).error().name, "time");
  EXPECT_EQ(from({{"clouds", 1.5}}).error().name, "clouds");
  EXPECT_EQ(from({{"sun", std::string("moon")}}).error().name, "sun");
  EXPECT_EQ(from({{"cloud", 0.5}}).error().name, "cloud");
}

TEST(Look, IsEditedByTexts) {
  const Look before{.sun = SunChoice::kFixed, .clouds = 0.8, .quality = Quality::kLow};
  const auto look = from_text({"time=06:30", "haze=0.5"}, before);
  ASSERT_TRUE(look);
  EXPECT_EQ(look->sun, SunChoice::kTime);
  EXPECT_EQ(look->solar_time_h, 6.5);
  EXPECT_EQ(look->haze, 0.5);
  EXPECT_EQ(look->clouds, 0.8) << "what is not named stays";
  EXPECT_EQ(look->quality, Quality::kLow);
}

TEST(Look, RefusesTextsThatSayNothing) {
  for (const char* edit : {"", "=", "clouds", "clouds=", "clouds=much", "clouds=1x", "clouds=nan", "clouds=2", "sky=1",
                           "quality=best", "time=7", "palette=mauve", "ground=", "density=0"}) {
    EXPECT_FALSE(from_text({edit})) << edit;
  }
}

TEST(Look, IsBroughtWithinLimits) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Look hostile{.sun = static_cast<SunChoice>(77),
                     .latitude_deg = 1e300,
                     .longitude_deg = kNan,
                     .solar_time_h = kInfinity,
                     .sun_height_deg = -kInfinity,
                     .sun_azimuth_deg = 1e9,
                     .clouds = -1.0,
                     .haze = 9.0,
                     .exposure_ev = 1000.0,
                     .quality = static_cast<Quality>(200),
                     .palette = static_cast<Palette>(6),
                     .ground = static_cast<GroundKind>(255),
                     .density = 1e9};
  EXPECT_EQ(within_limits(hostile),
            (Look{.latitude_deg = 90.0, .sun_azimuth_deg = 360.0, .clouds = 0.0, .haze = 1.0, .exposure_ev = 4.0}));
  EXPECT_EQ(within_limits(Look{}), Look{});
}

}  // namespace
}  // namespace yuragi::look
