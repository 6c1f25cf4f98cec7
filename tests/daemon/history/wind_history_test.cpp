#include "daemon/history/wind_history.hpp"

#include <gtest/gtest.h>

#include "daemon/history/history_json.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::history {
namespace {

constexpr std::int64_t kMinute_ms = 60'000;

UtcTime after_minutes(std::int64_t minutes) {
  return UtcTime(std::chrono::milliseconds(test::kSampleUtc_ms + minutes * kMinute_ms));
}
wind::Reading reading_from(std::int64_t mono_ms, double speed_m_s, double direction_deg) {
  wind::Reading reading = test::reading_at(mono_ms, speed_m_s);
  reading.direction_deg = direction_deg;
  return reading;
}

TEST(WindHistory, StepsHaveLeastMeanAndLargest_AndGapsAreGaps) {
  const test::TemporaryFolder folder;
  // Steps of 10 s in an hour: two readings in the first, then none for 30 s, then one.
  test::write_session(folder / "a.windlog",
                      {reading_from(1000, 2.0, 350.0), reading_from(3000, 4.0, 20.0), test::reading_at(41'000, 7.0)});
  const auto history = read_wind_history(folder / "a.windlog", after_minutes(60), 1);
  ASSERT_TRUE(history) << history.error().message;
  EXPECT_EQ(history->step_s, 10);
  EXPECT_EQ(history->step_count, 361U);
  EXPECT_EQ(history->begin_s, test::kSampleUtc_ms / 1000);
  ASSERT_EQ(history->sensors.size(), 1U);
  const std::vector<Step>& steps = history->sensors[0].steps;
  EXPECT_EQ(history->sensors[0].name, "mast");
  EXPECT_EQ(steps[0].min_m_s, 2.0);
  EXPECT_EQ(steps[0].mean_m_s(), 3.0);
  EXPECT_EQ(steps[0].max_m_s, 4.0);
  // 2 m/s from 350 and 4 m/s from 20 degrees: the faster counts twice as much.
  EXPECT_NEAR(wind::direction_from_deg(steps[0].vector_sum_m_s), 10.1, 0.1);
  for (const std::size_t gap : {1U, 2U, 3U, 5U, 360U}) EXPECT_EQ(steps[gap].readings, 0U) << gap;
  EXPECT_EQ(steps[4].max_m_s, 7.0);

  const std::string json = history_json(*history);
  EXPECT_NE(json.find(R"("mean_m_s":[3.0,null,null,null,7.0,null)"), std::string::npos) << json.substr(0, 500);
  EXPECT_NE(json.find(R"("direction_deg":[10.0,null,null,null,null)"), std::string::npos);
}

TEST(WindHistory, OnlyTheLastHours_InFewSteps) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", {test::reading_at(0, 9.0), test::reading_at(120 * kMinute_ms, 3.0)});
  for (unsigned hours = 1; hours <= kMaxHistory_h; ++hours) {
    const auto history = read_wind_history(folder / "a.windlog", after_minutes(122), hours);
    ASSERT_TRUE(history);
    EXPECT_LE(history->step_count, static_cast<std::size_t>(kMaxSteps) + 1) << hours;
    std::uint64_t readings = 0;
    for (const Step& step : history->sensors.at(0).steps) readings += step.readings;
    EXPECT_EQ(readings, hours <= 2 ? 1U : 2U) << hours;
  }
  const auto later = read_wind_history(folder / "a.windlog", after_minutes(1000), 1);
  ASSERT_TRUE(later);
  EXPECT_TRUE(later->sensors.empty());
}

TEST(WindHistory, ASensorOfTwoSessionsIsOne_AndWhatIsBeingWrittenIsRead) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", {test::reading_at(1000, 2.0)});
  auto writer = drivers::windlog::Writer::open(folder / "a.windlog");
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->begin_session({test::at_ms(20'000, test::kSampleUtc_ms + 20'000), "yuragi test", ""}));
  for (const char* const name : {"mast", "roof"}) {
    const auto sensor = writer->add_sensor(name, "synthetic", "");
    ASSERT_TRUE(sensor);
    ASSERT_TRUE(writer->append(*sensor, test::reading_at(21'000, 5.0)));
  }
  ASSERT_TRUE(writer->commit());
  const auto history = read_wind_history(folder / "a.windlog", after_minutes(60), 1);
  ASSERT_TRUE(history) << history.error().message;
  ASSERT_EQ(history->sensors.size(), 2U);
  EXPECT_EQ(history->sensors[0].steps[0].readings + history->sensors[0].steps[2].readings, 2U);
  EXPECT_EQ(history->sensors[1].name, "roof");
  ASSERT_TRUE(writer->close());
}

TEST(WindHistory, CompletedFilesOfASeriesBelongToIt) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.windlog";
  test::write_session(drivers::windlog::part_name(file, after_minutes(0)), {test::reading_at(0, 2.0)});
  test::write_session(file, {test::reading_at(10 * kMinute_ms, 5.0)});
  const auto history = read_wind_history(file, after_minutes(60), 1);
  ASSERT_TRUE(history) << history.error().message;
  ASSERT_EQ(history->sensors.size(), 1U);
  EXPECT_EQ(history->sensors[0].steps[0].max_m_s, 2.0);
  EXPECT_EQ(history->sensors[0].steps[60].max_m_s, 5.0);
}

TEST(WindHistory, WithoutARecordingItSaysSo) {
  const test::TemporaryFolder folder;
  const auto history = read_wind_history(folder / "none.windlog", after_minutes(1), 24);
  ASSERT_FALSE(history);
  EXPECT_EQ(history.error().kind, FailureKind::kNoInput);
}

}  // namespace
}  // namespace yuragi::daemon::history
