#include "drivers/windlog/iso_time.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace yuragi::drivers::windlog {
namespace {

using namespace std::chrono_literals;

constexpr UtcTime kIsoAfternoon{std::chrono::seconds(1'532'095'200)};  // 2018-07-20T14:00:00Z

TEST(IsoTime, ReadsAllUsualForms) {
  EXPECT_EQ(parse_iso_time("2018-07-20T14:00:00Z"), kIsoAfternoon);
  EXPECT_EQ(parse_iso_time("2018-07-20 14:00:00"), kIsoAfternoon);
  EXPECT_EQ(parse_iso_time("2018/07/20 14:00"), kIsoAfternoon);
  EXPECT_EQ(parse_iso_time("2018-07-20"), kIsoAfternoon - 14h);
  EXPECT_EQ(parse_iso_time("2018-07-20 14:00:00.100000"), kIsoAfternoon + 100ms);
  EXPECT_EQ(parse_iso_time("2018-07-20T14:00:00,5Z"), kIsoAfternoon + 500ms);
  EXPECT_EQ(parse_iso_time("2018-07-20T14:00:00.123456789Z"), kIsoAfternoon + 123'456'789ns);
  EXPECT_EQ(parse_iso_time("2018-07-20T14:00:00.1234567899Z"), kIsoAfternoon + 123'456'789ns);
  EXPECT_EQ(parse_iso_time("2018-07-20T16:00:00+02:00"), kIsoAfternoon);
  EXPECT_EQ(parse_iso_time("2018-07-20T16:00:00 +0200"), kIsoAfternoon);
  EXPECT_EQ(parse_iso_time("2018-07-20T09:30:00.5-04:30"), kIsoAfternoon + 500ms);
  EXPECT_EQ(parse_iso_time("2018-07-20T23+09"), std::nullopt);
  EXPECT_EQ(parse_iso_time("1969-12-31T23:59:59.5Z"), UtcTime(-500ms));
  EXPECT_EQ(parse_iso_time("2016-12-31T23:59:60Z"), UtcTime(std::chrono::sys_days(std::chrono::year(2017) / 1 / 1)));
}

TEST(IsoTime, RefusesWhatIsNoTime) {
  for (const char* text : {"",
                           " ",
                           "noon",
                           "2018",
                           "2018-07",
                           "2018-13-01",
                           "2018-02-30",
                           "2018-07-20T",
                           "2018-07-20T24:00:00",
                           "2018-07-20T14:60",
                           "2018-07-20T14:00:61",
                           "2018-07-20T14:00:00.",
                           "2018-07-20T14:00:00.Z",
                           "2018-07-20T14:00:00+",
                           "2018-07-20T14:00:00+2",
                           "2018-07-20T14:00:00+25:00",
                           "2018-07-20T14:00:00Zulu",
                           "2018-07-20x14:00:00",
                           "-018-07-20",
                           "20180720T140000",
                           "0001-01-01",
                           "9999-12-31T23:59:59Z",
                           "1532095200"}) {
    EXPECT_EQ(parse_iso_time(text), std::nullopt) << text;
  }
}

TEST(IsoTime, IsWrittenInWholeSeconds) {
  for (const char* text : {"2018-07-20T14:00:00Z", "1969-12-31T23:59:59Z"}) {
    const auto moment = parse_iso_time(text);
    ASSERT_TRUE(moment);
    EXPECT_EQ(iso_time_text(*moment + std::chrono::milliseconds(999)), text);
  }
}

}  // namespace
}  // namespace yuragi::drivers::windlog
