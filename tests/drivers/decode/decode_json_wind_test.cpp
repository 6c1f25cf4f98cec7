// Answers of our own making, in the forms of public weather services, Shelly, ESPHome and Home Assistant.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/decode/network/json_wind.hpp"
#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::network {
namespace {

using testing::Optional;

JsonPlaces places() {
  return {.speed = "/wind/speed", .direction = "/wind/direction", .gust = "/wind/gust", .time = "/time"};
}

Refusal refusal_of(std::string_view answer, const JsonPlaces& places) {
  const auto wind = decode_json_wind(answer, places);
  EXPECT_FALSE(wind) << answer;
  return wind ? Refusal::kOverrun : wind.error();
}

/// The wind where the speed is 4 and this stands at "direction".
DecodedWind with_direction(const std::string& direction) {
  const auto wind = decode_json_wind(R"({"wind": {"speed": 4, "direction": )" + direction + "}}", places());
  EXPECT_TRUE(wind) << direction;
  return wind ? wind->wind : DecodedWind();
}

TEST(JsonWind, IsReadAtItsPlaces) {
  const auto wind = decode_json_wind(R"({"time": 1717200000, "wind": {"speed": 36.0, "direction": 270, "gust": 54}})",
                                     {.speed = "/wind/speed",
                                      .direction = "/wind/direction",
                                      .gust = "/wind/gust",
                                      .time = "/time",
                                      .metres_per_second = kMetresPerSecondPerKmh});
  ASSERT_TRUE(wind);
  EXPECT_THAT(wind->wind.speed_m_s, Optional(testing::DoubleNear(10.0, 1e-9)));
  EXPECT_THAT(wind->wind.gust_m_s, Optional(testing::DoubleNear(15.0, 1e-9)));
  EXPECT_THAT(wind->wind.direction_deg, Optional(270.0));
  EXPECT_EQ(wind->wind.status, DecodedStatus::kGood);
  EXPECT_EQ(wind->time, "1717200000");
}

TEST(JsonWind, StandsInArraysAndTexts) {
  const auto list = decode_json_wind(R"([{"a/b": [{}, {"v": " 4.5 "}], "at": "2024-06-01T00:00:00Z"}])",
                                     {.speed = "/0/a~1b/1/v", .time = "/0/at"});
  ASSERT_TRUE(list);
  EXPECT_THAT(list->wind.speed_m_s, Optional(4.5));
  EXPECT_EQ(list->time, "2024-06-01T00:00:00Z");
}

TEST(JsonWind, HasItsDirectionInDegreesOrAsAPoint) {
  EXPECT_THAT(with_direction("45").direction_deg, Optional(45.0));
  EXPECT_THAT(with_direction("\"45.5\"").direction_deg, Optional(45.5));
  EXPECT_THAT(with_direction("360").direction_deg, Optional(0.0));
  EXPECT_THAT(with_direction("\"NW\"").direction_deg, Optional(315.0));
  EXPECT_THAT(with_direction("\" wsw \"").direction_deg, Optional(247.5));
}

TEST(JsonWind, ADirectionNeverDiscardsTheSpeed) {
  for (const char* none : {"null", "\"unavailable\"", "\"\"", "\"VRB\""}) {
    EXPECT_EQ(with_direction(none), DecodedWind({.speed_m_s = 4.0})) << none;
  }
  for (const char* odd : {"-1", "999", "\"north by west\"", "true", "[]", "{\"deg\": 5}", "\"1e999\""}) {
    EXPECT_EQ(with_direction(odd), DecodedWind({.speed_m_s = 4.0, .status = DecodedStatus::kUncertain})) << odd;
  }
  EXPECT_TRUE(decode_json_wind(R"({"wind": {"speed": 4}})", places()));
}

TEST(JsonWind, NeitherDoesAGust) {
  const auto gust_of = [](const std::string& gust) {
    return decode_json_wind(R"({"wind": {"speed": 4, "gust": )" + gust + "}}", places())->wind;
  };
  EXPECT_THAT(gust_of("6").gust_m_s, Optional(6.0));
  EXPECT_EQ(gust_of("3"), DecodedWind({.speed_m_s = 4.0})) << "below the speed";
  EXPECT_EQ(gust_of("null"), DecodedWind({.speed_m_s = 4.0}));
  EXPECT_EQ(gust_of("900").status, DecodedStatus::kUncertain);
  EXPECT_EQ(gust_of("900").gust_m_s, std::nullopt);
}

TEST(JsonWind, IsRefusedForItsSpeed) {
  for (const char* none : {"{}", "[]", "4", "null", R"({"wind": null})", R"({"wind": {"speed": null}})",
                           R"({"wind": {"speed": "unknown"}})", R"({"wind": [1, 2]})"})
    EXPECT_EQ(refusal_of(none, places()), Refusal::kInvalid) << none;
  for (const char* odd : {"", "{", "{}}", "\xff", R"({"wind": {"speed": true}})", R"({"wind": {"speed": {}}})",
                          R"({"wind": {"speed": "4 m/s"}})", R"({"wind": {"speed": 1e999}})"})
    EXPECT_EQ(refusal_of(odd, places()), Refusal::kMalformed) << odd;
  for (const char* wrong : {"-1", "121", "\"-4\""})
    EXPECT_EQ(refusal_of(R"({"wind": {"speed": )" + std::string(wrong) + "}}", places()), Refusal::kImplausible);
}

TEST(JsonWind, OddPlacesAreNone) {
  for (const char* odd : {"/01", "/-", "/99999999999999999999", "/a", "/0/0", "/"})
    EXPECT_EQ(refusal_of("[4]", {.speed = odd}), Refusal::kInvalid) << odd;
}

TEST(JsonWind, HasATimeThatIsANumberOrAShortText) {
  const auto time_of = [](const std::string& time) {
    return decode_json_wind(R"({"wind": {"speed": 4}, "time": )" + time + "}", places())->time;
  };
  EXPECT_EQ(time_of("17.5"), "17.5");
  EXPECT_EQ(time_of("\"noon\""), "noon");
  for (const std::string& none : {std::string("null"), std::string("[1]"), "\"" + std::string(65, '0') + "\""})
    EXPECT_EQ(time_of(none), "");
}

TEST(JsonWind, ATextOfBracketsIsRefused) {
  const std::string deep(kMaxJsonAnswer / 2, '[');
  EXPECT_EQ(refusal_of(deep, places()), Refusal::kMalformed);
  EXPECT_EQ(refusal_of(deep + std::string(deep.size(), ']'), places()), Refusal::kInvalid);
  EXPECT_EQ(refusal_of(std::string(kMaxJsonAnswer + 1, ' '), places()), Refusal::kMalformed);
}

}  // namespace
}  // namespace yuragi::drivers::decode::network
