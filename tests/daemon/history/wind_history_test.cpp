#include "daemon/history/wind_history.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "daemon/history/history_json.hpp"
#include "daemon/history/means_file.hpp"
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
  for (unsigned hours = 1; hours <= kMaxHistory_h; hours += 1 + hours / 50) {
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

constexpr unsigned kYear_h = kMaxHistory_h;
constexpr std::int64_t kDay_min = 24 * 60;

/// The history of a year up to a day after `minutes`; its failure fails the test.
WindHistory year(const std::filesystem::path& file, std::int64_t minutes) {
  const auto history = read_wind_history(file, after_minutes(minutes + kDay_min), kYear_h);
  EXPECT_TRUE(history) << (history ? "" : history.error().message);
  return history ? *history : WindHistory{};
}
/// The first sensor's step that a time is in.
Step step_at(const WindHistory& history, std::int64_t minutes) {
  const std::int64_t utc_s = test::kSampleUtc_ms / 1000 + minutes * 60;
  if (history.sensors.empty()) return {};
  return history.sensors[0].steps.at(static_cast<std::size_t>((utc_s - history.begin_s) / history.step_s));
}
std::uint64_t readings_of(const WindHistory& history) {
  std::uint64_t readings = 0;
  for (const SensorHistory& sensor : history.sensors)
    for (const Step& step : sensor.steps) readings += step.readings;
  return readings;
}
/// Adds a session, of the monotonic time 0 on, whose clock shows other times than kSampleUtc_ms from there on.
void write_session_at(const std::filesystem::path& file, std::int64_t minutes, std::vector<wind::Reading> readings) {
  for (wind::Reading& reading : readings) reading.time.utc += std::chrono::minutes(minutes);
  test::write_session(file, readings);
}

TEST(WindHistoryOfMeans, AYearHasStepsOfADay_WithTheGustsOfDevices) {
  const test::TemporaryFolder folder;
  std::vector<wind::Reading> readings;
  for (std::int64_t day = 0; day < 300; ++day) {  // 2 and 4 m/s, with a gust, on each day but some
    if (day >= 100 && day < 110) continue;
    readings.push_back(reading_from(day * kDay_min * kMinute_ms, 2.0, 350.0));
    readings.back().gust_m_s = 9.0;
    readings.push_back(reading_from((day * kDay_min + 100) * kMinute_ms, 4.0, 20.0));
  }
  test::write_session(folder / "a.windlog", readings);
  const WindHistory history = year(folder / "a.windlog", 299 * kDay_min);
  EXPECT_EQ(history.step_s, 86400);
  EXPECT_EQ(history.step_count, 367U);
  EXPECT_EQ(history.begin_s % 86400, 0);
  EXPECT_EQ(readings_of(history), 2U * 290);
  for (const std::int64_t day : {0, 99, 110, 299}) {
    const Step step = step_at(history, day * kDay_min);
    ASSERT_EQ(step.readings, 2U) << day;
    EXPECT_EQ(step.mean_m_s(), 3.0);
    EXPECT_EQ(step.min_m_s, 2.0);
    EXPECT_EQ(step.max_m_s, 9.0);
    EXPECT_NEAR(wind::direction_from_deg(step.vector_sum_m_s), 10.1, 0.1);
  }
  for (const std::int64_t day : {-1, 100, 109, 300}) EXPECT_EQ(step_at(history, day * kDay_min).readings, 0U) << day;
}

TEST(WindHistoryOfMeans, TheStepsOfAWeekAndAMonthAreSumsOfTheSame) {
  EXPECT_FALSE(is_of_means(24));
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", {test::reading_at(0, 2.0), test::reading_at(40 * kMinute_ms, 4.0)});
  for (const unsigned hours : {7U * 24, 31U * 24}) {
    EXPECT_TRUE(is_of_means(hours));
    const auto history = read_wind_history(folder / "a.windlog", after_minutes(kDay_min), hours);
    ASSERT_TRUE(history) << history.error().message;
    EXPECT_EQ(step_at(*history, 0).max_m_s, hours == 7 * 24 ? 2.0 : 4.0);
    EXPECT_EQ(readings_of(*history), 2U);
  }
}

TEST(WindHistoryOfMeans, EachReadingCountsOnce_AlsoInTheFileThatGrowsAndIsThenRenamed) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.windlog";
  auto writer = drivers::windlog::Writer::open(file);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, test::kSampleUtc_ms), "yuragi test", ""}));
  const auto mast = writer->add_sensor("mast", "synthetic", "");
  const auto roof = writer->add_sensor("roof", "synthetic", "");
  ASSERT_TRUE(mast && roof);
  for (std::uint64_t number = 0; number < 5; ++number) {
    // The roof's readings are committed later than later ones of the mast.
    const auto at_ms = static_cast<std::int64_t>(number) * kMinute_ms;
    ASSERT_TRUE(writer->append(*mast, test::reading_at(at_ms, 3.0)));
    if (number > 0) {
      ASSERT_TRUE(writer->append(*roof, test::reading_at(at_ms - kMinute_ms / 2, 3.0)));
    }
    ASSERT_TRUE(writer->commit());
    for (int again = 0; again < 2; ++again) EXPECT_EQ(readings_of(year(file, 10)), 2 * number + 1);
  }
  ASSERT_TRUE(writer->close());
  const std::filesystem::path part = drivers::windlog::part_name(file, after_minutes(0));
  std::filesystem::rename(file, part);
  test::write_session(file, {test::reading_at(20 * kMinute_ms, 3.0)});
  for (int again = 0; again < 2; ++again) EXPECT_EQ(readings_of(year(file, 30)), 10U);
  // What is deleted is still known, and what comes back does not count again.
  std::filesystem::rename(part, folder / "elsewhere");
  for (int again = 0; again < 2; ++again) EXPECT_EQ(readings_of(year(file, 30)), 10U);
  std::filesystem::rename(folder / "elsewhere", part);
  EXPECT_EQ(readings_of(year(file, 30)), 10U);
}

TEST(WindHistoryOfMeans, WhereTheClockWasSetReadingsCountInTheStepsThatItShowed) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.windlog";
  test::write_session(file, {test::reading_at(0, 1.0)});
  EXPECT_EQ(readings_of(year(file, 10)), 1U);
  write_session_at(file, -3 * kDay_min, {test::reading_at(kMinute_ms, 5.0)});        // set back
  write_session_at(file, 9000 * kDay_min, {test::reading_at(2 * kMinute_ms, 7.0)});  // far ahead
  write_session_at(file, 0, {test::reading_at(3 * kMinute_ms, 3.0)});
  const WindHistory history = year(file, 10);
  EXPECT_EQ(readings_of(history), 3U);
  EXPECT_EQ(step_at(history, 0).mean_m_s(), 2.0);
  EXPECT_EQ(step_at(history, -3 * kDay_min).mean_m_s(), 5.0);
  EXPECT_EQ(readings_of(year(file, 9000 * kDay_min)), 1U);
  // A clock that is wrong at the time of a question loses nothing.
  EXPECT_EQ(readings_of(year(file, -100'000 * kDay_min)), 0U);
  EXPECT_EQ(readings_of(year(file, 10)), 3U);
}

TEST(WindHistoryOfMeans, DamagedFilesAreLeftOutAndCounted) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.windlog";
  const std::filesystem::path part = drivers::windlog::part_name(file, after_minutes(-kDay_min));
  std::ofstream(part) << "no recording";
  test::write_session(file, {test::reading_at(0, 3.0)});
  for (const unsigned hours : {24U, kYear_h}) {
    const auto history = read_wind_history(file, after_minutes(10), hours);
    ASSERT_TRUE(history) << history.error().message;
    EXPECT_EQ(history->files_left_out, 1U) << hours;
    EXPECT_EQ(readings_of(*history), 1U) << hours;
    EXPECT_NE(history_json(*history).find("\"files_left_out\":1"), std::string::npos);
  }
  std::filesystem::remove(part);
  write_session_at(part, -kDay_min, {test::reading_at(0, 5.0)});
  EXPECT_EQ(readings_of(year(file, 10)), 2U) << "the place in the file that was damaged is its own";
  EXPECT_EQ(year(file, 10).files_left_out, 0U);
}

TEST(WindHistoryOfMeans, DamagedOrForeignMeansAreMadeAgain) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.windlog";
  test::write_session(file, {test::reading_at(0, 3.0)});
  EXPECT_EQ(readings_of(year(file, 10)), 1U);
  const std::filesystem::path means = means_file_of(file);
  ASSERT_TRUE(std::filesystem::exists(means));
  std::ofstream(means, std::ios::trunc) << std::string(8192, 'x');
  EXPECT_EQ(readings_of(year(file, 10)), 1U);
  std::filesystem::copy_file(file, means, std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(readings_of(year(file, 10)), 1U);
}

TEST(WindHistoryOfMeans, ARequestToStopEndsIt) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(50'000));
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(read_wind_history(folder / "a.windlog", after_minutes(10), kYear_h, stop.get_token()));
}

TEST(MeansFile, OfTwoThatReadTheSameOnlyOneAdds) {
  const test::TemporaryFolder folder;
  auto means = MeansFile::open(folder / "means");
  ASSERT_TRUE(means) << means.error().message;
  const ReadPlace place{.recording_file = 7, .sensor = "mast"};
  const std::map<std::int64_t, Step> steps = {{0, {.readings = 1, .sum_m_s = 3.0, .min_m_s = 3.0, .max_m_s = 3.0}}};
  ASSERT_TRUE(means->add(place, std::nullopt, Nanoseconds(10), steps));
  const auto again = means->add(place, std::nullopt, Nanoseconds(10), steps);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, FailureKind::kUnavailable);
  EXPECT_EQ(means->read_to(place).value(), Nanoseconds(10));
  ASSERT_TRUE(means->add(place, Nanoseconds(10), Nanoseconds(20), steps));
  std::uint64_t readings = 0;
  ASSERT_TRUE(means->each_step(0, kKeptStep_s, 1,
                               [&](const std::string&, std::int64_t, const Step& step) { readings += step.readings; }));
  EXPECT_EQ(readings, 2U);
}

TEST(WindHistory, WithoutARecordingItSaysSo) {
  const test::TemporaryFolder folder;
  for (const unsigned hours : {24U, kYear_h}) {
    const auto history = read_wind_history(folder / "none.windlog", after_minutes(1), hours);
    ASSERT_FALSE(history);
    EXPECT_EQ(history.error().kind, FailureKind::kNoInput);
  }
}

}  // namespace
}  // namespace yuragi::daemon::history
