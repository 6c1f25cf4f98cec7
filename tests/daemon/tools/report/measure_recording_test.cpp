#include "daemon/tools/report/measure_recording.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <gmock/gmock.h>

#include "daemon/tools/report/state_history.hpp"
#include "tests/daemon/tools/report/report_samples.hpp"

namespace yuragi::daemon::tools::report {
namespace {

using test::made_readings;
using test::numbers_of;

/// A wind that is never quite the same.
double lively_m_s(std::size_t i) {
  return 6.0 + std::sin(0.3 * static_cast<double>(i)) + 0.4 * std::sin(1.7 * static_cast<double>(i));
}

TEST(MeasureRecording, ASilenceIsAGapFromReadingToReading) {
  auto readings =
      test::made_readings(600, 1000, [](std::size_t i, wind::Reading& reading) { reading.speed_m_s = lively_m_s(i); });
  readings.erase(readings.begin() + 100, readings.begin() + 160);
  readings.erase(readings.begin() + 300, readings.begin() + 303);  // too short to be told
  const auto numbers = test::numbers_of(readings);
  ASSERT_EQ(numbers.sensors.size(), 1U);
  const SensorNumbers& sensor = numbers.sensors[0];
  ASSERT_EQ(sensor.events.size(), 1U);
  EXPECT_EQ(sensor.events[0].state, RecordedState::kStale);
  EXPECT_DOUBLE_EQ(sensor.events[0].from_s, 99.0);
  EXPECT_DOUBLE_EQ(sensor.events[0].to_s, 160.0);
  const double all_s = std::accumulate(sensor.states.begin(), sensor.states.end(), 0.0,
                                       [](double sum, const StateTotal& total) { return sum + total.time_s; });
  EXPECT_NEAR(all_s, numbers.duration_s(), 1e-9) << "every moment has one state";
  EXPECT_DOUBLE_EQ(sensor.interval_s, 1.0);

  // A line does not lead over the gap.
  std::size_t breaks = 0;
  for (const TimeBin& bin : sensor.bins) breaks += bin.follows_silence ? 1 : 0;
  EXPECT_EQ(breaks, 1U);
}

TEST(MeasureRecording, ThePausesOfASourceThatSpeaksOnChangeAreNoGaps) {
  // It says something each 2 s, is calm for 50 minutes, speaks again, and is gone for two hours.
  auto readings =
      test::made_readings(200, 2000, [](std::size_t i, wind::Reading& reading) { reading.speed_m_s = lively_m_s(i); });
  for (std::size_t i = 100; i < readings.size(); ++i) {
    readings[i].time = test::at_ms(3'000'000 + 2000 * static_cast<std::int64_t>(i),
                                   test::kSampleUtc_ms + 3'000'000 + 2000 * static_cast<std::int64_t>(i));
  }
  readings.push_back(test::reading_at(10'800'000, 4.0));

  const auto gaps_of = [&](const std::string& driver, const std::string& options) {
    const auto numbers = test::numbers_of(readings, {}, driver, options);
    return numbers.sensors.at(0).events;
  };
  EXPECT_EQ(gaps_of("mqtt", "topic = \"wind\"\nsilence = 3600.0\n").size(), 2U);
  const auto gaps = gaps_of("mqtt", "topic = \"wind\"\nsilence = 3600.0\non_change = true\n");
  ASSERT_EQ(gaps.size(), 1U) << "the calm is none";
  EXPECT_EQ(gaps[0].state, RecordedState::kStale);
  EXPECT_DOUBLE_EQ(gaps[0].from_s, 3398.0);
  EXPECT_EQ(gaps_of("osc", "silence = 3600.0\non_change = true\n").size(), 1U);
}

TEST(MeasureRecording, TheMeanDirectionPassesThroughNorth) {
  const auto numbers = test::numbers_of(test::made_readings(200, 1000, [](std::size_t i, wind::Reading& reading) {
    reading.speed_m_s = 5.0;
    reading.direction_deg = i % 2 == 0 ? 350.0 : 10.0;
  }));
  const SensorNumbers& sensor = numbers.sensors[0];
  EXPECT_NEAR(std::remainder(*sensor.direction_deg, 360.0), 0.0, 1e-9);
  EXPECT_NEAR(*sensor.steadiness, std::cos(10.0 * std::numbers::pi / 180.0), 1e-9);
  EXPECT_NEAR(sensor.rose.share[0][5], 1.0, 1e-12) << "north, 5 m/s and more";
}

TEST(MeasureRecording, TheColorsOfTheRoseReachTheStrongestWind) {
  for (const double strongest_m_s : {3.0, 5.9, 6.1, 11.0, 23.0, 47.0}) {
    const auto numbers = test::numbers_of(test::made_readings(200, 1000, [&](std::size_t i, wind::Reading& reading) {
      reading.speed_m_s = strongest_m_s * (0.005 * static_cast<double>(i) + 0.005);
      reading.direction_deg = 90.0;
    }));
    const WindRose& rose = numbers.sensors[0].rose;
    EXPECT_LT(strongest_m_s, rose.class_m_s * static_cast<double>(kRoseClasses)) << "in the last class";
    EXPECT_GT(strongest_m_s, 0.5 * rose.class_m_s * static_cast<double>(kRoseClasses - 1)) << rose.class_m_s;
    EXPECT_NEAR(rose.calm_share + std::accumulate(rose.share[4].begin(), rose.share[4].end(), 0.0), 1.0, 1e-9);
    // As many in each class as its width holds.
    EXPECT_NEAR(rose.share[4][1], std::min(rose.class_m_s, strongest_m_s - rose.class_m_s) / strongest_m_s, 0.011);
  }
}

TEST(MeasureRecording, WhatIsFrozenOrASpikeIsToldAndNotCounted) {
  const auto numbers = test::numbers_of(test::made_readings(2000, 1000, [](std::size_t i, wind::Reading& reading) {
    reading.speed_m_s = i >= 500 && i < 700 ? 7.25 : i == 1000 ? 60.0 : lively_m_s(i);
  }));
  const SensorNumbers& sensor = numbers.sensors[0];
  EXPECT_LT(sensor.max_m_s, 8.0);
  EXPECT_EQ(sensor.spikes, 1U);
  EXPECT_EQ(sensor.states[static_cast<std::size_t>(RecordedState::kSpike)].count, 1U);
  const StateTotal& frozen = sensor.states[static_cast<std::size_t>(RecordedState::kFrozen)];
  EXPECT_EQ(frozen.count, 1U);
  EXPECT_NEAR(frozen.time_s, 170.0, 2.0) << "from when it was noticed, after 30 s";
  EXPECT_LT(sensor.believed, sensor.readings - 160);
}

TEST(MeasureRecording, GustsAreMeansOfThreeSeconds) {
  // Ten a second; one burst of 1 s is a third of a gust.
  const auto numbers = test::numbers_of(test::made_readings(6100, 100, [](std::size_t i, wind::Reading& reading) {
    reading.speed_m_s = 5.0 + 0.01 * static_cast<double>(i % 2) + (i >= 3000 && i < 3010 ? 3.0 : 0.0);
  }));
  const SensorNumbers& sensor = numbers.sensors[0];
  EXPECT_NEAR(*sensor.gust_3s_m_s, 6.005, 1e-9);
  EXPECT_EQ(sensor.blocks.blocks, 1U);
  EXPECT_NEAR(*sensor.blocks.gust_factor, 6.005 / 5.01, 1e-3);

  // Once in 2 s no gust is seen.
  const auto slow = test::numbers_of(
      test::made_readings(100, 2000, [](std::size_t i, wind::Reading& reading) { reading.speed_m_s = lively_m_s(i); }));
  EXPECT_FALSE(slow.sensors[0].gust_3s_m_s);
}

TEST(MeasureRecording, HoursAreThoseOfTheZone) {
  Settings settings;
  settings.utc_offset = [](UtcTime) { return Nanoseconds(std::chrono::minutes(330)); };
  // From 14:00 UTC on, for 25 hours, six an hour; the first hour is windy.
  const auto numbers = test::numbers_of(test::made_readings(151, 600'000,
                                                            [](std::size_t i, wind::Reading& reading) {
                                                              reading.speed_m_s = (i < 6 ? 5.0 : 2.0) +
                                                                                  0.01 * static_cast<double>(i % 5);
                                                            }),
                                        settings);
  ASSERT_TRUE(numbers.sensors[0].diurnal);
  const auto& hours = *numbers.sensors[0].diurnal;
  // 14:00 UTC is 19:30 there: three windy readings before eight o'clock, three after; the others of that hour are calm.
  EXPECT_NEAR(hours[12].mean_m_s, 2.02, 0.03);
  EXPECT_EQ(hours[19].count, 9U);
  EXPECT_NEAR(hours[19].mean_m_s, (3 * 5.0 + 6 * 2.0) / 9.0 + 0.02, 0.03);
  EXPECT_EQ(hours[20].count, 10U);
  EXPECT_NEAR(hours[20].mean_m_s, (3 * 5.0 + 7 * 2.0) / 10.0 + 0.02, 0.03);
}

TEST(MeasureRecording, MonthsFitIntoTheSameBinsAndKeepTheirExtremes) {
  const auto numbers = test::numbers_of(test::made_readings(20'000, 60'000, [](std::size_t i, wind::Reading& reading) {
    reading.speed_m_s = i == 12'345 ? 9.5 : lively_m_s(i);
  }));
  const SensorNumbers& sensor = numbers.sensors[0];
  ASSERT_EQ(sensor.bins.size(), kTimeBins);
  double highest = 0.0;
  std::uint64_t count = 0;
  for (const TimeBin& bin : sensor.bins) {
    highest = std::max(highest, bin.max_m_s);
    count += bin.count;
  }
  EXPECT_EQ(highest, 9.5);
  EXPECT_EQ(count, 20'000U);
  EXPECT_LE(sensor.directions.size(), 1501U);
}

TEST(MeasureRecording, SeesThatTheClockWasSet) {
  auto readings =
      test::made_readings(100, 1000, [](std::size_t i, wind::Reading& reading) { reading.speed_m_s = lively_m_s(i); });
  for (std::size_t i = 50; i < 100; ++i) readings[i].time.utc -= std::chrono::hours(24 * 3650);
  const auto numbers = test::numbers_of(readings);
  EXPECT_EQ(numbers.clock_sets, 1U);
  EXPECT_NEAR(numbers.largest_clock_set_s, -3650.0 * 86400.0, 1.0);
  EXPECT_EQ(numbers.duration_s(), 99.0);
  EXPECT_TRUE(numbers.sensors[0].events.empty());
}

TEST(MeasureRecording, AnUnevenPaceIsMadeEven) {
  // Readings of a slow sine at alternating intervals: the spectrum's line is where it belongs.
  auto readings = test::made_readings(4000, 1000, [](std::size_t i, wind::Reading& reading) {
    const std::int64_t shift_ms = i % 2 == 0 ? 200 : -200;
    reading.time.mono += std::chrono::milliseconds(shift_ms + 300);
    reading.speed_m_s =
        6.0 + std::sin(2.0 * std::numbers::pi * 0.05 * (static_cast<double>(i) + 1e-3 * static_cast<double>(shift_ms)));
  });
  const auto numbers = test::numbers_of(readings);
  ASSERT_TRUE(numbers.sensors[0].spectrum);
  const SpectrumNumbers& spectrum = *numbers.sensors[0].spectrum;
  EXPECT_NEAR(spectrum.step_s, 1.0, 1e-3);
  const auto peak = std::ranges::max_element(spectrum.density_m2_s2_hz) - spectrum.density_m2_s2_hz.begin();
  EXPECT_NEAR(spectrum.frequency_hz(static_cast<std::size_t>(peak)), 0.05, spectrum.frequency_hz(1));
  const double variance = std::accumulate(spectrum.density_m2_s2_hz.begin(), spectrum.density_m2_s2_hz.end(), 0.0) *
                          spectrum.frequency_hz(1);
  EXPECT_NEAR(variance, 0.5, 0.02);
}

TEST(MeasureRecording, NamesWhatIsThereWhereASensorIsNot) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(3), "roof");
  auto reader = drivers::windlog::Reader::open(folder / "a.windlog");
  ASSERT_TRUE(reader);
  Settings settings;
  settings.sensors = {"rooof"};
  const auto numbers = measure_recording(*reader, settings);
  ASSERT_FALSE(numbers);
  EXPECT_THAT(numbers.error().message, testing::HasSubstr("\"roof\""));
}

TEST(StateHistory, JoinsWhatTouchesAndKeepsTheLongest) {
  StateHistory history;
  double now_s = 0.0;
  for (int i = 1; i <= 1000; ++i) {
    history.add(RecordedState::kLive, now_s, now_s + 1.0);
    history.add(RecordedState::kStale, now_s + 1.0, now_s + 1.0 + 0.5 * i);
    history.add(RecordedState::kStale, now_s + 1.0 + 0.5 * i, now_s + 1.0 + i);
    now_s += 1.0 + i;
  }
  const auto events = history.events();
  ASSERT_EQ(events.size(), SensorNumbers::kMaxEvents);
  EXPECT_DOUBLE_EQ(events.front().length_s(), 901.0);
  EXPECT_DOUBLE_EQ(events.back().length_s(), 1000.0);
  const auto totals = history.totals();
  EXPECT_EQ(totals[static_cast<std::size_t>(RecordedState::kStale)].count, 1000U);
  EXPECT_DOUBLE_EQ(totals[static_cast<std::size_t>(RecordedState::kLive)].time_s, 1000.0);
}

}  // namespace
}  // namespace yuragi::daemon::tools::report
