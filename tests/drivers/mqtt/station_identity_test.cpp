#include "drivers/mqtt/station_identity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::drivers::mqtt {
namespace {

using testing::HasSubstr;

constexpr Nanoseconds kPatience = std::chrono::minutes(15);
const StationIdentity kOurs = {.model = "Acurite-5n1", .id = "115", .channel = "A"};
const StationIdentity kNeighbours = {.model = "Fineoffset-WS80", .id = "0a003b", .channel = ""};

MonoTime after(Nanoseconds time) {
  return MonoTime() + std::chrono::hours(1) + time;
}

TEST(StationIdentity, IsReadFromNumbersAndText) {
  EXPECT_EQ(station_of(Payload(R"({"model":"Acurite-5n1","id":115,"channel":"A"})")), kOurs);
  EXPECT_EQ(station_of(Payload(R"({"model":"Fineoffset-WS80","id":"0a003b"})")), kNeighbours);
  EXPECT_TRUE(station_of(Payload(R"({"model":null,"id":1.5,"channel":[1]})")).is_empty());
  EXPECT_TRUE(station_of(Payload("7")).is_empty());
  EXPECT_TRUE(station_of(Payload("{")).is_empty());
}

TEST(StationIdentity, CoversAllThatItDoesNotName) {
  EXPECT_TRUE(StationIdentity().covers(kOurs));
  EXPECT_TRUE((StationIdentity{.model = "Acurite-5n1", .id = "", .channel = ""}.covers(kOurs)));
  EXPECT_TRUE(kOurs.covers(kOurs));
  EXPECT_FALSE(kOurs.covers(kNeighbours));
  EXPECT_FALSE((StationIdentity{.model = "", .id = "115", .channel = "B"}.covers(kOurs)));
}

TEST(StationIdentity, IsShownShortAndPrintable) {
  EXPECT_EQ(describe(kOurs), "Acurite-5n1, id 115, channel A");
  EXPECT_EQ(describe(StationIdentity()), "a station without a name");
  const std::string hostile = describe({.model = std::string(60'000, 'x') + "\x1b[2J", .id = "\x1b[2J", .channel = ""});
  EXPECT_LT(hostile.size(), 100U);
  EXPECT_EQ(hostile.find('\x1b'), std::string::npos);
}

TEST(StationChoice, StaysWithTheFirstUntilItFallsSilent) {
  StationChoice choice(kPatience);
  EXPECT_TRUE(choice.offer(kOurs, after(std::chrono::minutes(0))));
  EXPECT_FALSE(choice.offer(kNeighbours, after(std::chrono::minutes(1))));
  EXPECT_TRUE(choice.is_read(kOurs));
  EXPECT_FALSE(choice.offer(kNeighbours, after(std::chrono::minutes(14)))) << "ours is late, but not yet silent";
  EXPECT_TRUE(choice.offer(kNeighbours, after(std::chrono::minutes(15))));
  EXPECT_TRUE(choice.is_read(kNeighbours));
  EXPECT_FALSE(choice.offer(kOurs, after(std::chrono::minutes(16))));
  choice.restart();
  EXPECT_TRUE(choice.offer(kOurs, after(std::chrono::minutes(17))));
}

TEST(StationChoice, WarnsWhileAnotherIsHeard) {
  StationChoice choice(kPatience);
  choice.offer(kOurs, after(std::chrono::minutes(0)));
  EXPECT_EQ(choice.warning(after(std::chrono::minutes(0))), "");
  choice.offer(kNeighbours, after(std::chrono::minutes(1)));
  const std::string warning = choice.warning(after(std::chrono::minutes(2)));
  EXPECT_THAT(warning, HasSubstr(describe(kOurs)));
  EXPECT_THAT(warning, HasSubstr(describe(kNeighbours)));
  choice.offer({.model = "a third", .id = "", .channel = ""}, after(std::chrono::minutes(3)));
  EXPECT_EQ(choice.warning(after(std::chrono::minutes(3))), warning) << "it does not change at each message";
  choice.offer(kOurs, after(std::chrono::minutes(16)));
  EXPECT_EQ(choice.warning(after(std::chrono::minutes(16))), "") << "not heard for so long";
}

}  // namespace
}  // namespace yuragi::drivers::mqtt
