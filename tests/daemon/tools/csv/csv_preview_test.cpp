#include "daemon/tools/csv/csv_preview.hpp"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::tools::csv {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

wind::Reading reading_at(Nanoseconds time, double speed_m_s, std::optional<double> direction_deg = std::nullopt) {
  wind::Reading reading;
  reading.time = {MonoTime(time), UtcTime(time)};
  reading.speed_m_s = speed_m_s;
  reading.direction_deg = direction_deg;
  return reading;
}

Preview preview_of(int count, Nanoseconds interval, const std::function<double(int)>& speed_m_s) {
  Preview preview;
  for (int i = 0; i < count; ++i) preview.take("a", reading_at(i * interval, speed_m_s(i)));
  return preview;
}

TEST(CsvPreview, ShowsTimesIntervalGapsStrengthAndDirections) {
  Preview preview;
  EXPECT_THAT(preview.describe(), IsEmpty());
  preview.take("a", reading_at(0s, 1.0, 0.0));
  preview.take("a", reading_at(10s, 2.0, 90.0));
  preview.take("a", reading_at(20s, 8.0, 91.0));
  preview.take("a", reading_at(620s, 1.0));
  EXPECT_THAT(preview.describe(), ElementsAre("from 1970-01-01T00:00:00.000Z to 1970-01-01T00:10:20.000Z",
                                              "a reading every 10 s, 1 gap, the longest 10 min",
                                              "mean 3.00 m/s, strongest 8.00 m/s, largest change 7.00 m/s",
                                              "directions in 75 % of the readings, most from E: N E"));
}

TEST(CsvPreview, EachSensorHasItsOwnInterval) {
  Preview preview;
  for (int i = 0; i < 20; ++i) {
    preview.take("a", reading_at(i * 1s, 1.0));
    preview.take("b", reading_at(i * 1s, 20.0));
  }
  EXPECT_THAT(preview.describe(), Contains(HasSubstr("every 1 s, no gaps")));
  EXPECT_THAT(preview.implausible(), IsEmpty()) << "the speeds of two sensors are no changes";
}

TEST(CsvPreview, NamesWhatIsHardlyAWind) {
  const auto calm = [](int i) { return 3.0 + 0.1 * (i % 3); };
  EXPECT_THAT(preview_of(100, 1s, calm).implausible(), IsEmpty());
  EXPECT_THAT(preview_of(100, 10ms, calm).implausible(), IsEmpty());
  EXPECT_THAT(preview_of(100, 9ms, calm).implausible(), ElementsAre(HasSubstr("below 0.01 s")));
  EXPECT_THAT(preview_of(100, 1s, [](int) { return 41.0; }).implausible(),
              ElementsAre(HasSubstr("the mean is 41.0 m/s")));
  EXPECT_THAT(preview_of(100, 1s, [](int i) { return i % 3 == 0 ? 20.0 : 1.0; }).implausible(),
              ElementsAre(HasSubstr("changes by more than 10 m/s")));
  EXPECT_THAT(preview_of(100, 1s, [](int i) { return i % 10 == 0 ? 20.0 : 1.0; }).implausible(), IsEmpty());
}

}  // namespace
}  // namespace yuragi::daemon::tools::csv
