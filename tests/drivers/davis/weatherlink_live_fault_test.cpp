// What a WeatherLink Live and its network can do wrong, and what the driver makes of it: with a simulated one that
// serves HTTP and sends datagrams on this machine.
#include <memory>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/davis/weatherlink_live_sensor.hpp"
#include "simulators/davis/weatherlink_live.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/text_bench.hpp"

namespace yuragi::drivers::davis {
namespace {

using simulators::FaultKind;
using simulators::davis::WeatherLinkLive;
using testing::HasSubstr;

class WeatherLinkLiveFault : public testing::Test {
 protected:
  void connect(ParameterValues::Map given = {}) {
    const std::uint16_t udp_port = free_port(SOCK_DGRAM);
    auto http = simulators::text::make_tcp_wire("127.0.0.1", 0);
    const std::string place = http->place();
    given["host"] = std::string("127.0.0.1");
    given["http_port"] = std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))};
    given.try_emplace("port", std::int64_t{udp_port});
    auto live = std::make_unique<WeatherLinkLive>(
        bench_.observed(std::move(http)), bench_.observed(simulators::text::make_udp_wire("127.0.0.1", udp_port)),
        simulators::davis::WeatherLinkLiveOptions{.broadcast_port = udp_port},
        simulators::MeasuredWind(
            std::make_unique<StillWind>(simulators::PlayedMoment{.speed_m_s = 10 * 0.44704, .direction_deg = 123.0})));
    live_ = live.get();
    const WeatherLinkLiveSettings settings = weatherlink_live_settings_of(values_for("weatherlink", given));
    bench_.put(std::move(live), std::make_unique<WeatherLinkLiveSensor>(settings, bench_.port(settings.http),
                                                                        bench_.port(settings.broadcasts)));
  }

  bool is_live() {
    bench_.sink.readings.clear();
    return bench_.run_until(60.0, {}, [this] {
      return bench_.sink.readings.size() >= 3 && bench_.sink.last_state() == wind::LinkState::kConnected;
    });
  }
  void expect_only_the_wind() {
    for (const wind::WindReading& reading : bench_.sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, 10 * 0.44704, 1e-9);
      EXPECT_EQ(reading.direction_deg, 123.0);
    }
  }
  void expect_return() {
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(15.0);
    EXPECT_GE(bench_.sink.readings.size(), 5U);
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
  }

  TextBench bench_;
  WeatherLinkLive* live_ = nullptr;
};

TEST_F(WeatherLinkLiveFault, WithoutAnyItIsAskedForBroadcastsAgainInTime) {
  connect();
  ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
  EXPECT_EQ(live_->broadcast_requests(), 1);
  bench_.run(130.0);
  EXPECT_GE(bench_.sink.readings.size(), 50U) << "one each 2.5 s";
  EXPECT_EQ(live_->broadcast_requests(), 2);
  EXPECT_GT(live_->broadcasts_until_s(), 400.0);
  EXPECT_TRUE(bench_.sink.refusals.empty());
  expect_only_the_wind();
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("WeatherLink Live 001D0A700002 at 127.0.0.1:"));
  const wind::StationQuantities& said = bench_.sink.station_quantities.back();
  EXPECT_NEAR(said.air_temperature_c.value_or(0.0), 14.5, 1e-9);
  EXPECT_NEAR(said.pressure_hpa.value_or(0.0), 1013.24, 0.01);
  EXPECT_EQ(said.relative_humidity_percent, 65.0);
  EXPECT_NEAR(said.rain_rate_mm_h.value_or(0.0), 3.0, 1e-9);
  EXPECT_NEAR(said.rain_total_mm.value_or(0.0), 7.4, 1e-9);
}

TEST_F(WeatherLinkLiveFault, WithoutBroadcastsTheWindIsThatOfTheConditions) {
  connect({{"port", std::int64_t{free_port(SOCK_DGRAM)}}});
  bench_.run(45.0);
  EXPECT_GE(bench_.sink.readings.size(), 4U) << "one each 10 s";
  expect_only_the_wind();
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("without broadcasts: they go to port "));
}

TEST_F(WeatherLinkLiveFault, Silence) {
  connect();
  ASSERT_TRUE(is_live());
  bench_.run(2.0);
  bench_.run(45.0, FaultKind::kSilence);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 2);
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("does not reply"));
  expect_return();
}

TEST_F(WeatherLinkLiveFault, Freeze) {
  connect();
  ASSERT_TRUE(is_live());
  bench_.run(20.0, FaultKind::kFreeze);
  EXPECT_GE(bench_.sink.readings.size(), 7U) << "the driver publishes what the device says; the hub judges it";
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
  expect_return();
}

TEST_F(WeatherLinkLiveFault, Spike) {
  connect();
  ASSERT_TRUE(is_live());
  bench_.run(60.0);
  bench_.run(5.0, FaultKind::kSpike);
  EXPECT_NEAR(bench_.sink.readings.back().speed_m_s, 55.0, 0.01);
  EXPECT_EQ(bench_.sink.judge.fault(), wind::judging::ReadingFault::kSpike);
  for (const wind::WindReading& believed : bench_.sink.believed) {
    EXPECT_NEAR(believed.speed_m_s, 10 * 0.44704, 1e-9) << "the hub keeps it from the wind";
  }
  expect_return();
}

TEST_F(WeatherLinkLiveFault, Garbage) {
  connect();
  ASSERT_TRUE(is_live());
  bench_.run(40.0, FaultKind::kGarbage);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_GE(bench_.sink.count(decode::Refusal::kMalformed), 8);
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("check that it is a WeatherLink Live"));
  expect_return();
}

TEST_F(WeatherLinkLiveFault, Partial) {
  connect();
  ASSERT_TRUE(is_live());
  bench_.run(40.0, FaultKind::kPartial);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_GE(bench_.sink.count(decode::Refusal::kMalformed), 8);
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
  expect_return();
}

TEST_F(WeatherLinkLiveFault, WrongId) {
  connect();
  ASSERT_TRUE(is_live());
  bench_.run(35.0, FaultKind::kWrongId);
  EXPECT_GE(bench_.sink.count(decode::Refusal::kNotMine), 12) << "the broadcasts of a neighbour's";
  expect_only_the_wind();
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("without broadcasts: check that this machine is in its network"));
  ASSERT_TRUE(is_live());
  expect_return();
}

TEST_F(WeatherLinkLiveFault, Late) {
  connect();
  bench_.run(40.0, FaultKind::kLate);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 2);
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
  bench_.run(10.0);
  expect_return();
}

TEST_F(WeatherLinkLiveFault, Exception) {
  connect();
  bench_.run(25.0, FaultKind::kException);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("HTTP 500"));
  expect_return();
}

TEST_F(WeatherLinkLiveFault, Disconnect) {
  connect();
  ASSERT_TRUE(is_live());
  bench_.run(40.0, FaultKind::kDisconnect);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("cannot connect to 127.0.0.1:"));
  expect_return();
}

TEST_F(WeatherLinkLiveFault, Unplug) {
  connect();
  ASSERT_TRUE(is_live());
  bench_.run(15.0, FaultKind::kUnplug);
  EXPECT_TRUE(bench_.sink.readings.empty());
  expect_return();
}

}  // namespace
}  // namespace yuragi::drivers::davis
