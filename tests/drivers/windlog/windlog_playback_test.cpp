#include "drivers/windlog/windlog_playback.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

using test::numbered_readings;
using test::reading_at;
using test::write_session;

Playback playback_of(const std::filesystem::path& file, const PlaybackOptions& options = {}) {
  return Playback::open(file, options).value();
}

/// Why it cannot be played; empty if it can.
std::string complaint(const std::filesystem::path& file, const PlaybackOptions& options) {
  const auto playback = Playback::open(file, options);
  return playback ? "" : playback.error().message;
}

TEST(WindlogPlayback, GivesEveryReadingInLogTime) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(1500));
  Playback playback = playback_of(folder / "a.windlog");
  for (int i = 0; i < 1500; ++i) {
    const auto played = playback.next().value();
    ASSERT_TRUE(played);
    EXPECT_DOUBLE_EQ(played->log_time_s, 0.1 * i);
    EXPECT_DOUBLE_EQ(played->reading.speed_m_s, 0.001 * i);
    EXPECT_EQ(played->sensor, "mast");
  }
  EXPECT_FALSE(playback.next().value());
  EXPECT_FALSE(playback.next().value());
  EXPECT_EQ(playback.skipped(), 0U);
}

TEST(WindlogPlayback, StartsWhereItIsTold) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(100));

  // Log time begins at the start that was asked for, not at the reading that happens to come first.
  EXPECT_NEAR(playback_of(folder / "a.windlog", {.start = "2.05"}).next().value()->log_time_s, 0.05, 1e-9);
  EXPECT_EQ(playback_of(folder / "a.windlog", {.start = "2"}).next().value()->reading.speed_m_s, 0.020);
  EXPECT_EQ(playback_of(folder / "a.windlog", {.start = "2018-07-20T14:00:04Z"}).next().value()->reading.speed_m_s,
            0.030);
  EXPECT_EQ(playback_of(folder / "a.windlog", {.start = "2018-07-20 14:00:04.5"}).next().value()->reading.speed_m_s,
            0.035);
  EXPECT_EQ(playback_of(folder / "a.windlog", {.start = "2018-07-20T16:00:04+02:00"}).next().value()->reading.speed_m_s,
            0.030);
}

TEST(WindlogPlayback, SaysWhatIsWrongWithAStart) {
  for (const char* start : {"soon", "-5", "1e300", "nan", "inf", "now", "2018-13-45T00:00:00Z", "12 s", "+1"}) {
    EXPECT_FALSE(check_playback_start(start)) << start;
  }
  for (const char* start : {"", "0", "12.5", "1e3", "2018-07-20", "2018-07-20T14:00:00Z"}) {
    EXPECT_TRUE(check_playback_start(start)) << start;
  }

  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(100));
  EXPECT_NE(complaint(folder / "a.windlog", {.start = "9.95"}).find("9.9"), std::string::npos);
  EXPECT_NE(complaint(folder / "a.windlog", {.start = "2019-01-01"}).find("ends before"), std::string::npos);
}

TEST(WindlogPlayback, PlaysTheSensorThatIsAskedFor) {
  const test::TemporaryFolder folder;
  {
    auto writer = Writer::open(folder / "a.windlog");
    ASSERT_TRUE(writer->begin_session({test::reading_at(0, 0).time, "yuragi test", ""}));
    const auto roof = writer->add_sensor("roof", "modbus", "");
    const auto mast = writer->add_sensor("mast", "modbus", "");
    for (int i = 0; i < 10; ++i) {
      ASSERT_TRUE(writer->append(*mast, test::reading_at(1000 + 100 * i, 1.0)));
      ASSERT_TRUE(writer->append(*roof, test::reading_at(1050 + 100 * i, 2.0)));
    }
  }
  const auto count = [&](const std::string& sensor, double speed_m_s) {
    Playback playback = playback_of(folder / "a.windlog", {.sensor = sensor});
    int matching = 0;
    while (const auto played = playback.next().value()) matching += played->reading.speed_m_s == speed_m_s ? 1 : 0;
    return matching;
  };
  EXPECT_EQ(count("", 1.0), 10) << "the one that spoke first";
  EXPECT_EQ(count("", 2.0), 0);
  EXPECT_EQ(count("roof", 2.0), 10);
  EXPECT_EQ(count("*", 1.0) + count("*", 2.0), 20);
  EXPECT_NE(complaint(folder / "a.windlog", {.sensor = "cellar"}).find("\"roof\", \"mast\""), std::string::npos);

  // Two players of one recording stay together: log time is the recording's, whoever speaks first.
  EXPECT_NEAR(playback_of(folder / "a.windlog", {.sensor = "roof"}).next().value()->log_time_s, 0.05, 1e-9);
}

TEST(WindlogPlayback, LoopsWithTheMeanIntervalAtTheSeam) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog",
                      {test::reading_at(0, 0.0), test::reading_at(100, 1.0), test::reading_at(400, 2.0)});
  Playback playback = playback_of(folder / "a.windlog", {.loop = true});
  const std::vector<double> expected = {0.0, 0.1, 0.4, 0.6, 0.7, 1.0, 1.2, 1.3, 1.6, 1.8};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto played = playback.next().value();
    ASSERT_TRUE(played);
    EXPECT_NEAR(played->log_time_s, expected[i], 1e-9);
    EXPECT_EQ(played->reading.speed_m_s, static_cast<double>(i % 3));
  }
}

TEST(WindlogPlayback, LoopsFromItsStart) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(20));
  Playback playback = playback_of(folder / "a.windlog", {.start = "1.85", .loop = true});
  for (const double expected : {0.05, 1.05, 2.05}) {
    EXPECT_NEAR(playback.next().value()->log_time_s, expected, 1e-9);
  }
}

TEST(WindlogPlayback, OfOneReadingLoopsOnceASecond) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", {test::reading_at(700, 3.0)});
  Playback playback = playback_of(folder / "a.windlog", {.loop = true});
  for (const double expected : {0.0, 1.0, 2.0}) EXPECT_EQ(playback.next().value()->log_time_s, expected);
}

TEST(WindlogPlayback, OfReadingsAtOneMomentMovesOnWhenItLoops) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", {test::reading_at(700, 3.0), test::reading_at(700, 4.0)});
  Playback playback = playback_of(folder / "a.windlog", {.loop = true});
  double last_s = 0.0;
  for (int i = 0; i < 2000; ++i) last_s = playback.next().value()->log_time_s;
  EXPECT_NEAR(last_s, 0.999, 1e-5);  // one of two at one moment is moved by a nanosecond
}

TEST(WindlogPlayback, RefusesWhatHasNothingToPlay) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "empty.windlog", {});
  EXPECT_NE(complaint(folder / "empty.windlog", {}).find("no reading"), std::string::npos);
  EXPECT_NE(complaint(folder / "absent.windlog", {}).find("the recording does not exist"), std::string::npos);
  EXPECT_NE(complaint(folder.path(), {}).find("is not a file"), std::string::npos);
}

}  // namespace
}  // namespace yuragi::drivers::windlog
