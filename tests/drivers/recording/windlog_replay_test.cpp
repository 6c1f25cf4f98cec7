// The driver `windlog`.
#include <fstream>

#include <gtest/gtest.h>

#include "drivers/recording/recording_player.hpp"
#include "drivers/sensor/driver.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::recording {

extern const sensor::DriverDescription kWindlogDriver;

namespace {

using namespace std::chrono_literals;
using test::numbered_readings;
using test::reading_at;
using test::write_session;

std::unique_ptr<sensor::Sensor> open_replay(const ParameterValues::Map& given) {
  const auto values = ParameterValues::resolve(kWindlogDriver.parameters, given);
  if (!values) throw std::runtime_error(values.error().message);
  return kWindlogDriver.open(*values);
}

TEST(WindlogReplay, PublishesEachReadingWhenItIsDue) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(30));
  const auto sensor = open_replay({{"file", (folder / "a.windlog").string()}});
  ManualClock clock;
  RecordingSink sink;
  const Instant begin = clock.now();
  for (int i = 0; i < 30; ++i) {
    const MonoTime next = sensor->poll(clock, sink);
    ASSERT_EQ(sink.readings.size(), static_cast<std::size_t>(i + 1));
    EXPECT_EQ(sink.readings.back().time.mono, begin.mono + 100ms * i);
    EXPECT_EQ(sink.readings.back().time.utc, begin.utc + 100ms * i);
    EXPECT_DOUBLE_EQ(sink.readings.back().speed_m_s, 0.001 * i);
    if (i < 29) {
      EXPECT_EQ(next, begin.mono + 100ms * (i + 1));
    }
    clock.advance_to(begin.mono + 100ms * (i + 1));
  }
  ASSERT_EQ(sink.links.size(), 2U);
  EXPECT_EQ(sink.links[0].state, wind::LinkState::kConnected);
  EXPECT_EQ(sink.links[1].state, wind::LinkState::kFinished);
  sensor->poll(clock, sink);
  EXPECT_EQ(sink.links.size(), 2U) << "the end is told once";
}

TEST(WindlogReplay, IsPacedByItsRate) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(30));
  for (const double rate : {0.01, 0.5, 4.0, 1000.0}) {
    const auto sensor = open_replay({{"file", (folder / "a.windlog").string()}, {"rate", rate}});
    ManualClock clock;
    RecordingSink sink;
    const MonoTime begin = clock.now().mono;
    const MonoTime next = sensor->poll(clock, sink);
    EXPECT_NEAR(seconds(next - begin), 0.1 / rate, 1e-9);
  }
}

TEST(WindlogReplay, PolledLateGivesEachReadingTheMomentAtWhichItWasDue) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(30));
  const auto sensor = open_replay({{"file", (folder / "a.windlog").string()}});
  ManualClock clock;
  RecordingSink sink;
  const Instant begin = clock.now();
  sensor->poll(clock, sink);
  clock.advance(550ms);
  sensor->poll(clock, sink);
  ASSERT_EQ(sink.readings.size(), 6U);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(sink.readings[static_cast<std::size_t>(i)].time.mono, begin.mono + 100ms * i);
    EXPECT_EQ(sink.readings[static_cast<std::size_t>(i)].time.utc, begin.utc + 100ms * i);
  }
}

TEST(WindlogReplay, GoesOnFromWhereItWasAfterALongSuspension) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(30));
  const auto sensor = open_replay({{"file", (folder / "a.windlog").string()}});
  ManualClock clock;
  RecordingSink sink;
  sensor->poll(clock, sink);
  clock.advance(8h);
  const MonoTime next = sensor->poll(clock, sink);
  EXPECT_EQ(sink.readings.size(), 2U);
  EXPECT_EQ(next, clock.now().mono + 100ms);
}

TEST(WindlogReplay, LoopsForEver) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(10));
  const auto sensor = open_replay({{"file", (folder / "a.windlog").string()}, {"loop", true}, {"seam", 0.0}});
  ManualClock clock;
  RecordingSink sink;
  const MonoTime begin = clock.now().mono;
  for (int i = 0; i < 100; ++i) clock.advance_to(sensor->poll(clock, sink));
  ASSERT_EQ(sink.readings.size(), 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(sink.readings[i].time.mono, begin + 100ms * static_cast<int>(i));
    EXPECT_DOUBLE_EQ(sink.readings[i].speed_m_s, 0.001 * static_cast<double>(i % 10));
  }
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
}

TEST(WindlogReplay, TriesAnUnreadableFileAgainUntilItCanBeRead) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  std::ofstream(file) << "not yet a recording";
  const auto sensor = open_replay({{"file", file.string()}});
  ManualClock clock;
  RecordingSink sink;
  Nanoseconds last_pause{0};
  for (int i = 0; i < 8; ++i) {
    const MonoTime next = sensor->poll(clock, sink);
    const Nanoseconds pause = next - clock.now().mono;
    EXPECT_GE(pause, last_pause);
    EXPECT_LE(pause, 30s);
    last_pause = pause;
    clock.advance_to(next);
  }
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_NE(sink.last_detail().find("a.windlog"), std::string::npos);
  EXPECT_TRUE(sink.readings.empty());

  std::filesystem::remove(file);
  test::write_session(file, test::numbered_readings(5));
  sensor->poll(clock, sink);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
  EXPECT_EQ(sink.readings.size(), 1U);
}

TEST(WindlogReplay, RefusesToBeOpenedWithoutAFileOrWithABadStart) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(5));
  EXPECT_THROW(open_replay({}), std::runtime_error);
  EXPECT_THROW(open_replay({{"file", std::string("/nonexistent/a.windlog")}}), std::runtime_error);
  EXPECT_THROW(open_replay({{"file", (folder / "a.windlog").string()}, {"start", std::string("soon")}}),
               std::runtime_error);
  EXPECT_THROW(open_replay({{"file", (folder / "a.windlog").string()}, {"rate", 0.0}}), std::runtime_error);
}

TEST(WindlogReplay, CarriesOutOrdersAndTellsHowItDoes) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  test::write_session(file, test::numbered_readings(100));
  const auto sensor = open_replay({{"file", file.string()}, {"loop", true}, {"seam", 0.0}});
  auto& player = dynamic_cast<Player&>(*sensor);
  ManualClock clock;
  RecordingSink sink;
  EXPECT_FALSE(player.report().position) << "nothing is open before the first poll";
  EXPECT_EQ(player.report().file, file.string());
  sensor->poll(clock, sink);
  EXPECT_DOUBLE_EQ(seconds(player.report().position->length), 9.9);
  EXPECT_TRUE(player.report().position->loops);

  EXPECT_EQ(player.order({.kind = PlayerOrder::Kind::kSeek, .place = "5"}), 1U);
  EXPECT_EQ(player.order({.kind = PlayerOrder::Kind::kPause}), 2U);
  EXPECT_EQ(player.report().orders_done, 0U);
  sensor->poll(clock, sink);
  EXPECT_EQ(player.report().orders_done, 2U);
  EXPECT_EQ(player.report().refusal, "");
  EXPECT_TRUE(player.report().position->is_paused);
  EXPECT_DOUBLE_EQ(seconds(player.report().position->log_time), 5.0);
  EXPECT_DOUBLE_EQ(sink.readings.back().speed_m_s, 0.050);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
  EXPECT_NE(sink.last_detail().find("paused"), std::string::npos);

  EXPECT_EQ(player.order({.kind = PlayerOrder::Kind::kSeek, .place = "500"}), 3U);
  sensor->poll(clock, sink);
  EXPECT_NE(player.report().refusal.find("9.9"), std::string::npos);
  EXPECT_DOUBLE_EQ(seconds(player.report().position->log_time), 5.0);

  player.order({.kind = PlayerOrder::Kind::kStep, .count = 2});
  sensor->poll(clock, sink);
  EXPECT_DOUBLE_EQ(sink.readings.back().speed_m_s, 0.052);
  EXPECT_EQ(player.report().refusal, "");
  player.order({.kind = PlayerOrder::Kind::kRate, .rate = 2.0});
  player.order({.kind = PlayerOrder::Kind::kResume});
  sensor->poll(clock, sink);
  clock.advance(1s);
  sensor->poll(clock, sink);
  EXPECT_NEAR(seconds(player.report().position->log_time), 7.2, 1e-6);
  EXPECT_NE(sink.last_detail().find("playing"), std::string::npos);
}

TEST(WindlogReplay, OrdersWithoutEndAreRefused) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(100));
  const auto sensor = open_replay({{"file", (folder / "a.windlog").string()}});
  auto& player = dynamic_cast<Player&>(*sensor);
  int taken = 0;
  while (taken < 100'000 && player.order({.kind = PlayerOrder::Kind::kPause})) ++taken;
  EXPECT_GT(taken, 10);
  EXPECT_LT(taken, 1000);
  ManualClock clock;
  RecordingSink sink;
  sensor->poll(clock, sink);
  EXPECT_EQ(player.report().orders_done, static_cast<std::uint64_t>(taken));
  EXPECT_TRUE(player.order({.kind = PlayerOrder::Kind::kResume})) << "there is room again";
}

TEST(WindlogReplay, RefusesAnOffsetFromUtcThatIsNone) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(5));
  try {
    open_replay({{"file", (folder / "a.windlog").string()}, {"utc_offset", std::string("Tokyo")}});
    FAIL() << "it was taken";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("utc_offset: \"Tokyo\""), std::string::npos) << error.what();
  }
}

TEST(WindlogReplay, LeavesTheWholeDaysOutOfAGapOfManyYears) {
  const test::TemporaryFolder folder;
  wind::Reading far = test::reading_at(1000, 2.0);
  far.time.mono += std::chrono::hours(24 * 365 * 140 + 3);
  test::write_session(folder / "a.windlog", {test::reading_at(1000, 1.0), far});
  const auto sensor = open_replay({{"file", (folder / "a.windlog").string()}, {"rate", 0.01}});
  ManualClock clock;
  RecordingSink sink;
  EXPECT_EQ(sensor->poll(clock, sink), clock.now().mono + std::chrono::hours(3 * 100));
  EXPECT_EQ(sink.readings.size(), 1U);
}

}  // namespace
}  // namespace yuragi::drivers::recording
