#include "daemon/values/reference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::values {
namespace {

using ::testing::HasSubstr;

Moment a_moment() {
  Moment moment;
  moment.names =
      std::make_shared<const Names>(Names{.sensors = {"roof"}, .places = {"door", "gate.gust"}, .scenes = {"meadow"}});
  moment.shaped[Quantity::kSpeed] = 3.0;
  moment.real[Quantity::kSpeed] = 5.0;
  moment.sensors = {{.speed_m_s = 4.0, .age_s = 0.5}};
  moment.shaped_places.resize(2);
  moment.shaped_places[0][Quantity::kSpeed] = 2.5;
  moment.shaped_places[0][Quantity::kGustNorm] = 0.25;
  moment.shaped_places[1][Quantity::kSpeed] = 2.75;
  moment.opacities = {0.5};
  return moment;
}

std::optional<double> value_of(std::string_view text, Wind wind = Wind::kShaped) {
  return Reference::parse(text).value().value_in(a_moment(), wind);
}

TEST(ReferenceTest, FindsEachKindOfValue) {
  EXPECT_EQ(value_of("speed"), 3.0);
  EXPECT_EQ(value_of("speed", Wind::kReal), 5.0);
  EXPECT_EQ(value_of("sensor:roof"), 4.0);
  EXPECT_EQ(value_of("sensor:roof.age"), 0.5);
  EXPECT_EQ(value_of("sensor:roof.direction"), std::nullopt) << "it sends none";
  EXPECT_EQ(value_of("place:door"), 2.5);
  EXPECT_EQ(value_of("place:door.gust_norm"), 0.25);
  EXPECT_EQ(value_of("scene:meadow"), 0.5);
  EXPECT_EQ(value_of("place:door", Wind::kReal), std::nullopt) << "not asked for";
  EXPECT_EQ(value_of("sensor:cellar"), std::nullopt);
}

TEST(ReferenceTest, RefusesWhatIsNoValue) {
  for (const char* text : {"", "wind", "Speed", "roof:speed", "place:", "place:.gust", "sensor:roof.gust", ":speed"})
    EXPECT_FALSE(Reference::parse(text)) << text;
  EXPECT_THAT(Reference::parse("gusts").error().message, HasSubstr("gust_norm"));
}

TEST(ReferenceTest, NamesWhatIsMissing) {
  const Names names = *a_moment().names;
  EXPECT_EQ(Reference::parse("speed").value().missing_in(names), std::nullopt);
  EXPECT_EQ(Reference::parse("place:door.peak").value().missing_in(names), std::nullopt);
  EXPECT_THAT(*Reference::parse("place:dor").value().missing_in(names), HasSubstr("there are: door, gate.gust"));
  EXPECT_THAT(*Reference::parse("scene:roof").value().missing_in(names), HasSubstr("no scene \"roof\""));
}

TEST(ReferenceTest, HasTheRangeOfItsPart) {
  EXPECT_EQ(Reference::parse("place:door.direction").value().description().max, 360.0);
  EXPECT_EQ(Reference::parse("scene:meadow").value().description().max, 1.0);
}

}  // namespace
}  // namespace yuragi::daemon::values
