// The driver of the HID stations with simulated stations, in one process: hours of their time in milliseconds.
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/hid/write_clock.hpp"
#include "simulators/usb/fineoffset.hpp"
#include "tests/support/hid_bench.hpp"

namespace yuragi::drivers::hid {
namespace {

using simulators::core::FaultKind;
using simulators::core::PlayedMoment;
using test::HidBench;
using testing::HasSubstr;

constexpr double kHour_s = 3600.0;

/// What a family promises.
struct Promise {
  std::string_view model;
  double every_s;        ///< from one wind to the next
  double tolerance_m_s;  ///< of its speed: half a step of its numbers
};
constexpr std::array<Promise, 6> kPromises = {{{"wmr100", 14.0, 0.051},
                                               {"wmr300", 2.75, 0.051},
                                               {"fineoffset", 48.0, 0.051},
                                               {"fineoffset-wh3080", 48.0, 0.051},
                                               {"acurite", 18.0, 0.12},
                                               {"te923", 33.0, 0.03}}};

std::string suffix_of_promise(const testing::TestParamInfo<Promise>& parameter) {
  std::string name(parameter.param.model);
  std::ranges::replace(name, '-', '_');
  return name;
}

class EveryStation : public testing::TestWithParam<Promise> {};
INSTANTIATE_TEST_SUITE_P(Hid, EveryStation, testing::ValuesIn(kPromises), suffix_of_promise);

TEST_P(EveryStation, GivesTheWindAsOftenAsTheStationHasOne) {
  HidBench bench(GetParam().model);
  bench.run_for(kHour_s);
  const double expected = kHour_s / GetParam().every_s;
  EXPECT_NEAR(static_cast<double>(bench.readings()), expected, 0.1 * expected);
  EXPECT_EQ(bench.bus.opened, 1);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("at USB port 1-1.2"));
}

TEST_P(EveryStation, TellsTheWindAsItIs) {
  HidBench bench(GetParam().model);
  bench.bus.wind = [](double) { return PlayedMoment{8.6, 225.0}; };
  bench.run_for(300.0);
  ASSERT_GT(bench.readings(), 4U);
  int with_direction = 0;
  for (const wind::Reading& reading : bench.sink.readings) {
    EXPECT_NEAR(reading.speed_m_s, 8.6, GetParam().tolerance_m_s);
    EXPECT_NEAR(reading.gust_m_s.value_or(8.6), 8.6, GetParam().tolerance_m_s);
    if (reading.direction_deg) {
      EXPECT_EQ(*reading.direction_deg, 225.0);
      ++with_direction;
    }
  }
  EXPECT_GE(2 * with_direction, static_cast<int>(bench.readings()) - 1) << "AcuRite has one in every second report";
}

TEST_P(EveryStation, TellsCalmAsCalmAndAStormAsAStorm) {
  for (const double speed_m_s : {0.0, 45.0}) {
    HidBench bench(GetParam().model);
    bench.bus.wind = [speed_m_s](double) { return PlayedMoment{speed_m_s, 0.0}; };
    bench.run_for(300.0);
    ASSERT_GT(bench.readings(), 4U);
    EXPECT_NEAR(bench.sink.readings.back().speed_m_s, speed_m_s, GetParam().tolerance_m_s);
  }
}

TEST_P(EveryStation, KnowsAllSixteenPointsOfTheCompass) {
  HidBench bench(GetParam().model);
  for (int point = 0; point < 16; ++point) {
    bench.bus.wind = [point](double) { return PlayedMoment{5.0, 22.5 * point}; };
    bench.run_for(120.0);
    const auto last =
        std::ranges::find_if(bench.sink.readings.rbegin(), bench.sink.readings.rend(),
                             [](const wind::Reading& reading) { return reading.direction_deg.has_value(); });
    ASSERT_NE(last, bench.sink.readings.rend());
    EXPECT_NEAR(*last->direction_deg, 22.5 * point, 0.51);  // WMR300 has whole degrees
  }
}

TEST_P(EveryStation, ShowsEveryReportToTheSink) {
  HidBench bench(GetParam().model);
  bench.run_for(120.0);
  const auto sent = std::ranges::count(bench.sink.raws, sensor::RawDirection::kSent, &RecordingSink::Raw::direction);
  const auto received = static_cast<std::ptrdiff_t>(bench.sink.raws.size()) - sent;
  EXPECT_GE(received, static_cast<std::ptrdiff_t>(bench.readings()));
  const bool sends_nothing = GetParam().model == "acurite";  // it is asked by control transfers
  EXPECT_EQ(sent == 0, sends_nothing);
}

TEST_P(EveryStation, NeverSpins) {
  HidBench bench(GetParam().model);
  bench.run_for(kHour_s);
  const auto received =
      std::ranges::count(bench.sink.raws, sensor::RawDirection::kReceived, &RecordingSink::Raw::direction);
  EXPECT_LT(bench.polls, 3 * kHour_s + 3.0 * static_cast<double>(received));
}

TEST_P(EveryStation, SeesAPulledPlugWithinSecondsAndComesBackByItself) {
  HidBench bench(GetParam().model);
  bench.bus.fault = [](double time_s) {
    return time_s > 100.0 && time_s < 200.0 ? std::optional(FaultKind::kUnplug) : std::nullopt;
  };
  bench.run_for(102.0);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
  bench.run_for(97.0);
  const std::size_t before = bench.readings();
  bench.run_for(80.0);
  EXPECT_GT(bench.readings(), before);
  EXPECT_EQ(bench.bus.opened, 2);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
}

TEST_P(EveryStation, RunsAtAnotherPaceWithItsSimulation) {
  HidBench bench(GetParam().model, {.pace = 20.0});
  bench.run_for(180.0);
  const double expected = 20.0 * 180.0 / GetParam().every_s;
  EXPECT_GT(static_cast<double>(bench.readings()), 0.8 * expected);
  EXPECT_LT(static_cast<double>(bench.readings()), 1.15 * expected);
}

TEST_P(EveryStation, GivesUpAWaitThatIsInterrupted) {
  HidBench bench(GetParam().model);
  bench.run_for(60.0);
  const std::size_t told = bench.sink.links.size();
  bench.sensor.interrupt();
  const MonoTime before = bench.bus.clock.now().mono;
  bench.sensor.poll(bench.bus.clock, bench.sink);
  EXPECT_EQ(bench.bus.clock.now().mono, before) << "it waited all the same";
  EXPECT_EQ(bench.sink.links.size(), told) << "a shutdown is no trouble of the station";
}

// --- what single families do

TEST(Wmr100Station, AsksAgainWhereTheStartReportWasNotHeard) {
  HidBench bench("wmr100");
  bench.bus.fault = [](double time_s) { return time_s < 100.0 ? std::optional(FaultKind::kSilence) : std::nullopt; };
  bench.run_for(99.0);
  EXPECT_EQ(bench.readings(), 0U);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("is silent"));
  bench.run_for(30.0);
  EXPECT_GT(bench.readings(), 0U);
}

TEST(Wmr300Station, TellsAnIdleConsoleToBeginOnce) {
  HidBench bench("wmr300");
  bench.run_for(600.0);
  EXPECT_EQ(std::ranges::count_if(bench.sink.raws,
                                  [](const RecordingSink::Raw& raw) {
                                    return raw.direction == sensor::RawDirection::kSent && raw.message[0] == 0x73;
                                  }),
            1);
}

TEST(Wmr300Station, SendsAHeartbeatEvery20SecondsAndAcknowledgesEachPacket) {
  HidBench bench("wmr300");
  bench.run_for(600.0);
  int heartbeats = 0;
  int acknowledgements = 0;
  int packets = 0;
  for (const RecordingSink::Raw& raw : bench.sink.raws) {
    if (raw.direction == sensor::RawDirection::kReceived) {
      packets += raw.message[0] >= 0xD1 && raw.message[0] <= 0xDC;
    } else {
      heartbeats += raw.message[0] == 0xA6;
      acknowledgements += raw.message[0] == 'A';
    }
  }
  EXPECT_EQ(heartbeats, 30);
  EXPECT_GT(packets, 200);
  EXPECT_EQ(acknowledgements, packets);
}

/// A Fine Offset console that counts who comes near its writing, in a wind that changes all the time.
struct CountedConsole {
  explicit CountedConsole(const simulators::usb::HidModelOptions& options)
      : CountedConsole(
            std::make_unique<simulators::usb::FineOffset>(simulators::usb::FineOffsetRecord::kWh1080, options)) {}
  explicit CountedConsole(std::unique_ptr<simulators::usb::FineOffset> console)
      : counted(*console), bench(std::move(console), test::kind_of_model("fineoffset")) {
    bench.bus.wind = [](double time_s) { return PlayedMoment{std::floor(std::fmod(time_s, 997.0)) / 50.0, 0.0}; };
  }

  /// Which part of the blocks of that time was read near its writing.
  double part_near_writing(double duration_s) {
    const int near_before = counted.reads_near_writing();
    const int before = counted.blocks_read();
    bench.run_for(duration_s);
    return static_cast<double>(counted.reads_near_writing() - near_before) / (counted.blocks_read() - before);
  }

  const simulators::usb::FineOffset& counted;
  HidBench bench;
};

TEST(FineOffsetStation, KeepsAwayFromTheConsolesWritingOnceItKnowsWhenThatIs) {
  for (int seventh = 0; seventh < 9; ++seventh) {
    const double begins_s = 7.0 * seventh;
    CountedConsole console(simulators::usb::HidModelOptions{});
    console.bench.bus.begin();
    console.bench.bus.run_to(console.bench.bus.clock.now().mono + from_seconds(begins_s));
    console.bench.run_for(kHour_s);  // it learns
    EXPECT_LT(console.part_near_writing(4.0 * kHour_s), 0.01) << "by chance it would be 0.2; began at " << begins_s;
    EXPECT_EQ(console.bench.sink.refusals.size(), 0U);
  }
}

TEST(FineOffsetStation, KeepsAwayForADayWhileTheClocksDriftApart) {
  for (const double pace : {0.99995, 1.00005}) {  // 4 s a day, as quartzes do
    CountedConsole console(simulators::usb::HidModelOptions{.pace = pace});
    EXPECT_LT(console.part_near_writing(24.0 * kHour_s), 0.02) << pace;
  }
}

TEST(FineOffsetStation, ReadsEachMeasurementOnce) {
  auto console = std::make_unique<simulators::usb::FineOffset>(simulators::usb::FineOffsetRecord::kWh3080,
                                                               simulators::usb::HidModelOptions{});
  const simulators::usb::FineOffset& counted = *console;
  HidBench bench(std::move(console), test::kind_of_model("fineoffset"));
  bench.bus.wind = [](double time_s) { return PlayedMoment{std::round(std::fmod(time_s, 997.0)) / 100.0, 0.0}; };
  bench.run_for(2.0 * kHour_s);
  // Fixed block and record, each twice, and sometimes a record that reaches into a second block.
  EXPECT_LT(counted.blocks_read(), 1.1 * 6.0 * 2.0 * kHour_s / 48.0);
  EXPECT_NEAR(static_cast<double>(bench.readings()), 2.0 * kHour_s / 48.0, 4.0);
}

TEST(FineOffsetStation, HandsOnTheWeatherWithEachReading) {
  HidBench bench("fineoffset");
  bench.run_for(kHour_s);
  ASSERT_EQ(bench.sink.station_quantities.size(), bench.readings());
  for (const wind::StationQuantities& said : bench.sink.station_quantities) {
    EXPECT_EQ(said.air_temperature_c, 12.0);
    EXPECT_EQ(said.pressure_hpa, 1014.8);
    EXPECT_EQ(said.relative_humidity_percent, 58.0);
  }
  EXPECT_EQ(bench.sink.station_quantities.back().time.mono, bench.sink.readings.back().time.mono);
}

/// The last value of each quantity that a station handed on in an hour.
wind::StationQuantities last_weather_of(std::string_view model) {
  HidBench bench(model);
  bench.run_for(kHour_s);
  wind::StationQuantities last;
  for (const wind::StationQuantities& said : bench.sink.station_quantities) {
    EXPECT_TRUE(wind::plausible_part(said).has_value());
    EXPECT_LE(last.time.mono, said.time.mono);
    last.time = said.time;
    for (const wind::StationQuantity& each : wind::kStationQuantities) {
      if (said.*each.value) last.*each.value = said.*each.value;
    }
  }
  EXPECT_GT(bench.readings(), 70U) << "besides the wind, not in place of it";
  return last;
}

TEST(Wmr100Station, HandsOnTheWeatherOfItsOwnFrames) {
  const wind::StationQuantities last = last_weather_of("wmr100");
  EXPECT_EQ(last.air_temperature_c, 19.6);
  EXPECT_EQ(last.relative_humidity_percent, 58.0);
  EXPECT_EQ(last.pressure_hpa, 1005.0);
  EXPECT_NEAR(last.rain_total_mm.value_or(0.0), 63.5, 1e-9);
}

TEST(Wmr300Station, HandsOnTheWeatherOfItsOwnPackets) {
  const wind::StationQuantities last = last_weather_of("wmr300");
  EXPECT_EQ(last.air_temperature_c, -3.6);
  EXPECT_EQ(last.relative_humidity_percent, 58.0);
  EXPECT_EQ(last.pressure_hpa, 981.7);
  EXPECT_NEAR(last.rain_total_mm.value_or(0.0), 63.5, 1e-9);
  EXPECT_NEAR(last.rain_rate_mm_h.value_or(0.0), 2.54, 1e-9);
}

TEST(Te923Station, HandsOnTheWeatherOfItsBlock) {
  const wind::StationQuantities last = last_weather_of("te923");
  EXPECT_EQ(last.air_temperature_c, 19.65);
  EXPECT_EQ(last.relative_humidity_percent, 58.0);
  EXPECT_EQ(last.pressure_hpa, 1005.0);
  EXPECT_NEAR(last.rain_total_mm.value_or(0.0), 25.4, 1e-9);
}

TEST(AcuriteStation, HandsOnRainAndWeatherByTurns) {
  const wind::StationQuantities last = last_weather_of("acurite");
  EXPECT_NEAR(last.air_temperature_c.value_or(0.0), 18.61, 0.01);
  EXPECT_EQ(last.relative_humidity_percent, 83.0);
  EXPECT_NEAR(last.rain_total_mm.value_or(0.0), 12 * 0.254, 1e-9);
  EXPECT_FALSE(last.pressure_hpa.has_value());
}

TEST_P(EveryStation, HandsOnNoFalseWeatherWhileItsReportsAreHurt) {
  for (const FaultKind kind : {FaultKind::kGarbage, FaultKind::kBadChecksum, FaultKind::kPartial}) {
    HidBench bench(GetParam().model);
    bench.run_for(kHour_s);
    const auto whole = bench.sink.station_quantities;
    bench.bus.fault = [kind](double) { return std::optional(kind); };
    bench.run_for(kHour_s);
    for (std::size_t i = whole.size(); i < bench.sink.station_quantities.size(); ++i) {
      const wind::StationQuantities& said = bench.sink.station_quantities[i];
      for (const wind::StationQuantity& each : wind::kStationQuantities) {
        const bool was_said = std::ranges::any_of(
            whole, [&](const wind::StationQuantities& before) { return before.*each.value == said.*each.value; });
        EXPECT_TRUE(!(said.*each.value) || was_said) << each.name << " " << *(said.*each.value);
      }
    }
  }
}

TEST(FineOffsetStation, IsNotAskedMoreOftenThanItMeasures) {
  const auto readings_at = [](Nanoseconds interval) {
    HidBench bench("fineoffset", {.pace = 1.0, .poll_interval = interval});
    bench.run_for(kHour_s);
    return static_cast<double>(bench.readings());
  };
  EXPECT_NEAR(readings_at(std::chrono::seconds(5)), kHour_s / 48.0, 4.0);
  EXPECT_NEAR(readings_at(std::chrono::seconds(240)), kHour_s / 240.0, 3.0);
}

TEST(FineOffsetStation, SaysSoWhenTheConsoleDoesNotMeasureAnyMore) {
  /// A console that has locked up: it answers, and its memory never changes.
  class Stuck final : public simulators::usb::Device {
   public:
    const simulators::usb::Descriptors& descriptors() const override { return inner_.descriptors(); }
    std::span<const FaultKind> known_faults() const override { return inner_.known_faults(); }
    void advance(double time_s, const PlayedMoment& wind, std::optional<FaultKind> fault) override {
      // A time that hardly moves: enough for its answers, too little for its next measurement.
      inner_.advance(time_s < 300.0 ? time_s : 300.0 + std::min(time_s - 300.0, 5000.0) / 1000.0, wind, fault);
    }
    std::optional<simulators::usb::Bytes> control(const simulators::usb::SetupPacket& setup,
                                                  std::span<const std::uint8_t> data) override {
      return inner_.control(setup, data);
    }
    std::optional<simulators::usb::Bytes> in(std::uint8_t endpoint, std::size_t max_size) override {
      if (auto report = inner_.in(endpoint, max_size)) return report;
      return std::nullopt;
    }
    bool out(std::uint8_t endpoint, std::span<const std::uint8_t> data) override { return inner_.out(endpoint, data); }

   private:
    simulators::usb::FineOffset inner_{simulators::usb::FineOffsetRecord::kWh1080, {}};
  };
  HidBench bench(std::make_unique<Stuck>(), test::kind_of_model("fineoffset"));
  bench.run_for(299.0);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
  bench.run_for(900.0);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
}

TEST(AcuriteStation, PublishesAReportOnceAndLeavesOutAnOldDirection) {
  HidBench bench("acurite", {.pace = 1.0, .poll_interval = std::chrono::seconds(3)});
  bench.run_for(360.0);
  EXPECT_NEAR(static_cast<double>(bench.readings()), 20.0, 1.0) << "although it is asked six times as often";
  for (std::size_t i = 1; i < bench.readings(); ++i) {
    EXPECT_NE(bench.sink.readings[i].direction_deg.has_value(), bench.sink.readings[i - 1].direction_deg.has_value());
  }
}

TEST(Te923Station, AcknowledgesEachBlock) {
  HidBench bench("te923");
  bench.run_for(330.0);
  std::vector<int> commands;
  for (const RecordingSink::Raw& raw : bench.sink.raws) {
    if (raw.direction == sensor::RawDirection::kSent) commands.push_back(raw.message[0]);
  }
  ASSERT_GE(commands.size(), 20U);
  for (std::size_t i = 0; i < commands.size(); ++i) EXPECT_EQ(commands[i], i % 2 == 0 ? 0x05 : 0x24);
}

// --- faults at random

TEST_P(EveryStation, NeverTellsAFalseWindAndAlwaysComesBackUnderRandomFaults) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    HidBench bench(GetParam().model, {}, seed);
    // Winds far from each other, so that a false one is seen; faults that are no winds of their own.
    const auto wind_of = [](double time_s) {
      constexpr std::array kSpeeds_m_s = {2.0, 7.0, 12.0, 17.0, 22.0};
      return PlayedMoment{kSpeeds_m_s[static_cast<std::size_t>(time_s / 400.0) % kSpeeds_m_s.size()], 90.0};
    };
    std::vector<FaultKind> kinds = {FaultKind::kUnplug};
    for (const FaultKind kind : bench.bus.device().known_faults()) {
      if (kind != FaultKind::kFreeze && kind != FaultKind::kSpike) kinds.push_back(kind);
    }
    simulators::core::Faults faults(kinds);
    faults.add(simulators::core::RandomFaults{.every_s = 300.0, .duration_s = 60.0, .seed = seed});
    constexpr double kFaultsEnd_s = 6.0 * kHour_s;
    bench.bus.wind = wind_of;
    bench.bus.fault = [&faults](double time_s) { return time_s < kFaultsEnd_s ? faults.at(time_s) : std::nullopt; };
    bench.run_for(kFaultsEnd_s);

    const double start_s = seconds(bench.bus.clock.now().mono.time_since_epoch()) - bench.bus.now_s();
    for (const wind::Reading& reading : bench.sink.readings) {
      const double time_s = seconds(reading.time.mono.time_since_epoch()) - start_s;
      const double now_m_s = wind_of(time_s).speed_m_s;
      const double before_m_s = wind_of(std::max(0.0, time_s - 60.0)).speed_m_s;
      const double error_m_s =
          std::min(std::abs(reading.speed_m_s - now_m_s), std::abs(reading.speed_m_s - before_m_s));
      EXPECT_LT(error_m_s, GetParam().tolerance_m_s)
          << reading.speed_m_s << " m/s at " << time_s << " s, seed " << seed;
      EXPECT_EQ(reading.direction_deg.value_or(90.0), 90.0);
    }
    EXPECT_GT(static_cast<double>(bench.readings()), 0.4 * kFaultsEnd_s / GetParam().every_s);

    const std::size_t before = bench.readings();
    bench.run_for(200.0);
    EXPECT_GT(bench.readings(), before) << "seed " << seed;
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
  }
}

// --- devices that are none

/// Says anything, always.
class Babbler final : public simulators::usb::Device {
 public:
  Babbler(std::unique_ptr<simulators::usb::Device> shown, std::uint64_t seed)
      : shown_(std::move(shown)), random_(seed) {}

  const simulators::usb::Descriptors& descriptors() const override { return shown_->descriptors(); }
  std::span<const FaultKind> known_faults() const override { return {}; }
  void advance(double, const PlayedMoment&, std::optional<FaultKind>) override {}
  std::optional<simulators::usb::Bytes> control(const simulators::usb::SetupPacket& setup,
                                                std::span<const std::uint8_t>) override {
    if (random_() % 8 == 0) return std::nullopt;
    return babble(setup.length);
  }
  std::optional<simulators::usb::Bytes> in(std::uint8_t, std::size_t max_size) override {
    if (random_() % 4 == 0) return std::nullopt;
    return babble(max_size);
  }
  bool out(std::uint8_t, std::span<const std::uint8_t>) override { return random_() % 8 != 0; }

 private:
  simulators::usb::Bytes babble(std::size_t max_size) {
    simulators::usb::Bytes bytes(1 + random_() % std::max<std::size_t>(1, max_size));
    std::ranges::generate(bytes, [this] { return static_cast<std::uint8_t>(random_()); });
    return bytes;
  }

  std::unique_ptr<simulators::usb::Device> shown_;
  std::mt19937_64 random_;
};

TEST_P(EveryStation, OutlivesADeviceThatSaysAnything) {
  HidBench bench(std::make_unique<Babbler>(simulators::usb::make_hid_station(GetParam().model), 7),
                 test::kind_of_model(GetParam().model));
  bench.run_for(1800.0);
  EXPECT_GT(bench.sink.refusals.size(), 10U);
  EXPECT_TRUE(std::ranges::all_of(bench.sink.readings, wind::is_plausible));
  EXPECT_LE(bench.readings(), 2U) << "sums of 8 bits and marks can be met by chance";
}

// --- WriteClock

constexpr MonoTime at_s(double time_s) {
  return MonoTime(std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(time_s)));
}

TEST(WriteClockTest, KnowsNothingAtFirst) {
  const WriteClock clock(std::chrono::seconds(48), std::chrono::seconds(3));
  EXPECT_FALSE(clock.is_known());
  EXPECT_EQ(clock.clear_from(at_s(100)), at_s(100));
  EXPECT_EQ(clock.behind(at_s(100)), at_s(100));
}

TEST(WriteClockTest, KeepsAwayFromEveryLaterTime) {
  WriteClock clock(std::chrono::seconds(48), std::chrono::seconds(3));
  EXPECT_TRUE(clock.happened_between(at_s(100), at_s(106)));
  for (const double period_s : {0.0, 48.0, 4800.0}) {
    EXPECT_EQ(clock.clear_from(at_s(period_s + 96.9)), at_s(period_s + 96.9));
    EXPECT_EQ(clock.clear_from(at_s(period_s + 97.1)), at_s(period_s + 109.0));
    EXPECT_EQ(clock.clear_from(at_s(period_s + 108.9)), at_s(period_s + 109.0));
    EXPECT_EQ(clock.clear_from(at_s(period_s + 109.0)), at_s(period_s + 109.0));
    EXPECT_EQ(clock.behind(at_s(period_s + 109.0)), at_s(period_s + 109.0));
    EXPECT_EQ(clock.behind(at_s(period_s + 109.1)), at_s(period_s + 157.0));
  }
}

TEST(WriteClockTest, NarrowsWhatItKnowsByEachLook) {
  WriteClock clock(std::chrono::seconds(60), std::chrono::seconds(3));
  EXPECT_FALSE(clock.happened_between(at_s(0), at_s(60)));
  EXPECT_TRUE(clock.happened_between(at_s(10), at_s(58)));
  EXPECT_FALSE(clock.is_known()) << "48 of 60 s are too wide to keep away from";
  // The true time is 41 s past each minute.
  clock.happened_between(at_s(300 + 22), at_s(300 + 70));
  clock.happened_between(at_s(600 - 26), at_s(600 - 16));
  EXPECT_FALSE(clock.is_known() && clock.clear_from(at_s(941)) == at_s(941));
  EXPECT_TRUE(clock.is_known());
}

TEST(WriteClockTest, BelievesANewLookRatherThanAnOldOne) {
  WriteClock clock(std::chrono::seconds(48), std::chrono::seconds(3));
  clock.happened_between(at_s(100), at_s(106));
  clock.happened_between(at_s(168), at_s(174));
  EXPECT_EQ(clock.clear_from(at_s(171)), at_s(177));
  EXPECT_EQ(clock.clear_from(at_s(151)), at_s(151));
  clock.forget();
  EXPECT_EQ(clock.clear_from(at_s(171)), at_s(171));
}

}  // namespace
}  // namespace yuragi::drivers::hid
