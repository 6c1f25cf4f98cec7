// What a WeatherLink Live and its network can do wrong, and what the driver makes of it: with a simulated one that
// serves HTTP and sends datagrams on this machine.
#include <memory>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/davis/weatherlink_live_sensor.hpp"
#include "simulators/davis/weatherlink_live.hpp"
#include "tests/drivers/davis/davis_fault.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"

namespace yuragi::drivers::davis {
namespace {

using simulators::core::FaultKind;
using simulators::davis::WeatherLinkLive;
using testing::HasSubstr;

class WeatherLinkLiveFault : public DavisFault {
 protected:
  void connect(ParameterValues::Map given = {}) {
    const std::uint16_t udp_port = free_port(SOCK_DGRAM);
    auto http = simulators::text::make_tcp_wire("127.0.0.1", free_port(SOCK_STREAM));
    const std::string place = http->place();
    given["host"] = std::string("127.0.0.1");
    given["http_port"] = std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))};
    given.try_emplace("port", std::int64_t{udp_port});
    auto live = std::make_unique<WeatherLinkLive>(
        bench_.observed(std::move(http)), bench_.observed(simulators::text::make_udp_wire("127.0.0.1", udp_port)),
        simulators::davis::WeatherLinkLiveOptions{.broadcast_port = udp_port}, still_wind());
    live_ = live.get();
    const WeatherLinkLiveSettings settings = weatherlink_live_settings_of(values_for("weatherlink", given));
    bench_.put(std::move(live), std::make_unique<WeatherLinkLiveSensor>(settings, bench_.port(settings.http),
                                                                        bench_.port(settings.broadcasts)));
  }

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
  expect_weather();
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
  expect_no_wind(FaultKind::kSilence, 45.0, "does not reply");
  EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 2);
  expect_return();
}

TEST_F(WeatherLinkLiveFault, Freeze) {
  connect();
  expect_freeze_is_published();
}

TEST_F(WeatherLinkLiveFault, Spike) {
  connect();
  expect_spike_is_not_believed();
}

TEST_F(WeatherLinkLiveFault, Garbage) {
  connect();
  ASSERT_TRUE(is_live());
  expect_no_wind(FaultKind::kGarbage, 40.0, "check that it is a WeatherLink Live");
  EXPECT_GE(bench_.sink.count(decode::Refusal::kMalformed), 8);
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
  EXPECT_THAT(bench_.sink.last_detail(),
              HasSubstr("without broadcasts: check the firewall, and that this machine is in the same network"));
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
  expect_no_wind(FaultKind::kException, 25.0, "HTTP 500");
  expect_return();
}

TEST_F(WeatherLinkLiveFault, Disconnect) {
  connect();
  ASSERT_TRUE(is_live());
  expect_no_wind(FaultKind::kDisconnect, 40.0, "cannot connect to 127.0.0.1:");
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
