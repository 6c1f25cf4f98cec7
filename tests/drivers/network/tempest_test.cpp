// The driver as the daemon opens it, and the simulated hub, over real datagrams on the loopback.
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulators/network/tempest_simulator.hpp"
#include "tests/support/descriptor.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/still_wind.hpp"

namespace yuragi::drivers::network {
namespace {

using namespace std::chrono_literals;
using simulators::core::FaultKind;
using simulators::network::TempestOptions;
using simulators::network::TempestSimulator;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

constexpr simulators::core::PlayedMoment kTempestWind = {.speed_m_s = 7.25, .direction_deg = 123.0};

/// A socket that sends from this machine, also to the loopback's broadcast address.
class Sender {
 public:
  Sender() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const int yes = 1;
    setsockopt(socket_.get(), SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes);
  }
  void send(const std::string& text, std::uint16_t port, const char* to = "127.0.0.1") const {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    ASSERT_EQ(inet_pton(AF_INET, to, &address.sin_addr), 1);
    ASSERT_EQ(
        sendto(socket_.get(), text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof address),
        std::ssize(text));
  }

 private:
  Descriptor socket_;
};

std::string rapid_wind_of(const std::string& station, int time_s, const std::string& wind = "2.3,128") {
  return R"({"serial_number":")" + station + R"(","type":"rapid_wind","hub_sn":"HB-00000001","ob":[)" +
         std::to_string(1493322445 + time_s) + "," + wind + "]}";
}

/// The driver and what it hears, in a time that the test makes.
class TempestBench : public testing::Test {
 protected:
  /// Makes the driver, which listens when this returns.
  void listen(ParameterValues::Map given = {}) {
    given.try_emplace("port", std::int64_t{port_});
    sensor_ = driver_named("tempest").open(values_for("tempest", given));
    idle();
  }
  /// Polls until so many messages have been taken. False if they are not within a minute.
  bool take(std::size_t messages) {
    for (int polls = 0; polls < 240 && sink.raws.size() < messages; ++polls) sensor_->poll(clock_, sink);
    return sink.raws.size() >= messages;
  }
  void hear(const std::string& text) {
    sender_.send(text, port_);
    ASSERT_TRUE(take(sink.raws.size() + 1));
  }
  /// Nothing comes for so long.
  void idle(Nanoseconds time = 0s) {
    clock_.advance(time);
    sensor_->poll(clock_, sink);
  }

  /// Lets a simulated hub speak for so long, in the driver's time.
  void run(TempestSimulator& hub, double duration_s, std::optional<FaultKind> fault = {}) {
    const std::size_t taken = sink.raws.size();
    const std::uint64_t sent = hub.sent();
    for (const double end_s = time_s_ + duration_s; time_s_ < end_s; time_s_ += 1.0) {
      clock_.advance(1s);
      hub.serve({}, time_s_, fault);
      ASSERT_TRUE(take(taken + hub.sent() - sent));
    }
    idle();
  }
  TempestOptions options() const {
    TempestOptions options;
    options.port = port_;
    return options;
  }
  static simulators::core::MeasuredWind still_wind() {
    return simulators::core::MeasuredWind(std::make_unique<StillWind>(kTempestWind));
  }

  std::uint16_t port_ = free_port(SOCK_DGRAM);
  Sender sender_;
  ManualClock clock_;
  RecordingSink sink;
  std::unique_ptr<sensor::Sensor> sensor_;

 private:
  double time_s_ = 0.0;
};

/// With a hub whose station was heard.
class TempestFault : public TempestBench {
 protected:
  void SetUp() override { connect({}); }
  void connect(ParameterValues::Map given) {
    listen(std::move(given));
    hub_.emplace(options(), still_wind());
    expect_return();
  }
  /// It is well, says the wind and nothing else, and begins anew.
  void expect_return() {
    forget();
    run(*hub_, 30.0);
    ASSERT_GE(sink.readings.size(), 9U);
    expect_only_the_wind();
    EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected) << sink.last_detail();
    forget();
  }
  void suffer(double duration_s, FaultKind fault) { run(*hub_, duration_s, fault); }
  void expect_only_the_wind() const {
    for (const wind::Reading& reading : sink.readings) {
      EXPECT_EQ(reading.speed_m_s, kTempestWind.speed_m_s);
      EXPECT_EQ(reading.direction_deg, kTempestWind.direction_deg);
    }
  }
  void expect_nothing() const {
    EXPECT_TRUE(sink.readings.empty());
    EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting) << sink.last_detail();
  }
  void forget() {
    sink.readings.clear();
    sink.refusals.clear();
  }

  std::optional<TempestSimulator> hub_;
};

TEST_F(TempestFault, Silence) {
  suffer(70.0, FaultKind::kSilence);
  expect_nothing();
  EXPECT_THAT(sink.last_detail(),
              HasSubstr("no hub has been received at UDP port " + std::to_string(port_) + " for 60 s"));
  expect_return();
}

TEST_F(TempestFault, Freeze) {
  suffer(60.0, FaultKind::kFreeze);
  EXPECT_GE(sink.readings.size(), 18U) << "the driver publishes what the station says; the hub of sensors judges it";
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
  expect_return();
}

TEST_F(TempestFault, Spike) {
  suffer(12.0, FaultKind::kSpike);
  ASSERT_FALSE(sink.readings.empty());
  EXPECT_EQ(sink.readings.back().speed_m_s, 55.0);
  EXPECT_EQ(sink.judge.fault(), wind::judging::ReadingFault::kSpike);
  for (const wind::Reading& believed : sink.believed) EXPECT_EQ(believed.speed_m_s, kTempestWind.speed_m_s);
  expect_return();
}

TEST_F(TempestFault, Garbage) {
  suffer(70.0, FaultKind::kGarbage);
  expect_nothing();
  EXPECT_GE(sink.count(decode::Refusal::kMalformed), 20);
  expect_return();
}

TEST_F(TempestFault, Partial) {
  suffer(70.0, FaultKind::kPartial);
  expect_nothing();
  EXPECT_GE(sink.count(decode::Refusal::kMalformed), 20);
  expect_return();
}

TEST_F(TempestFault, WrongId) {
  connect({{"serial_number", std::string("ST-00000512")}});
  suffer(70.0, FaultKind::kWrongId);
  expect_nothing();
  EXPECT_GE(sink.count(decode::Refusal::kNotMine), 20);
  EXPECT_THAT(sink.last_detail(), HasSubstr("station ST-99999999"));
  EXPECT_THAT(sink.last_detail(), HasSubstr("not ST-00000512: check serial_number"));
  expect_return();
}

TEST_F(TempestFault, Unplug) {
  suffer(70.0, FaultKind::kUnplug);
  expect_nothing();
  EXPECT_THAT(sink.last_detail(), HasSubstr("receives hub HB-00013030"));
  EXPECT_THAT(sink.last_detail(), HasSubstr("check the station's battery"));
  expect_return();
}

class TempestDriver : public TempestBench {};

TEST_F(TempestDriver, SaysThatItWaits) {
  listen();
  idle(1s);
  EXPECT_THAT(sink.last_detail(), HasSubstr("waits for a hub's broadcasts at UDP port"));
}

TEST_F(TempestDriver, FollowsTheFirstOfTwoAndWarns) {
  listen();
  hear(rapid_wind_of("ST-00000001", 0));
  EXPECT_THAT(sink.last_detail(), HasSubstr("station ST-00000001 of hub HB-00000001 at UDP port"));
  EXPECT_THAT(sink.last_detail(), Not(HasSubstr("serial_number")));
  hear(rapid_wind_of("ST-00000002", 1, "9.9,10"));
  hear(rapid_wind_of("ST-00000001", 3));
  ASSERT_EQ(sink.readings.size(), 2U);
  EXPECT_EQ(sink.readings.back().speed_m_s, 2.3);
  EXPECT_EQ(sink.count(decode::Refusal::kNotMine), 1);
  EXPECT_THAT(sink.last_detail(),
              HasSubstr("ST-00000002 is received, too, but not used: select one with serial_number"));

  // Of one that has not been heard for long there is no warning any more.
  clock_.advance(12min);
  hear(rapid_wind_of("ST-00000001", 720));
  EXPECT_THAT(sink.last_detail(), Not(HasSubstr("serial_number")));
}

TEST_F(TempestDriver, TakesTheChosenOneWithoutAWarning) {
  listen({{"serial_number", std::string("ST-00000002")}});
  hear(rapid_wind_of("ST-00000001", 0));
  hear(rapid_wind_of("ST-00000002", 1, "9.9,10"));
  hear(rapid_wind_of("ST-00000001", 3));
  ASSERT_EQ(sink.readings.size(), 1U);
  EXPECT_EQ(sink.readings[0].speed_m_s, 9.9);
  EXPECT_THAT(sink.last_detail(), Not(HasSubstr("serial_number")));
}

TEST_F(TempestDriver, FollowsAnotherWhenTheFirstHasBeenSilentForLong) {
  listen();
  hear(rapid_wind_of("ST-00000001", 0));
  for (int time_s = 3; time_s <= 57; time_s += 3) {
    clock_.advance(3s);
    hear(rapid_wind_of("ST-00000002", time_s, "9.9,10"));
  }
  ASSERT_EQ(sink.readings.size(), 1U);
  idle(3s);
  EXPECT_THAT(sink.last_detail(), HasSubstr("check the station's battery"));
  hear(rapid_wind_of("ST-00000002", 63, "9.9,10"));
  ASSERT_EQ(sink.readings.size(), 2U);
  EXPECT_EQ(sink.readings.back().speed_m_s, 9.9);
}

TEST_F(TempestDriver, GivesMeanWindsWhereNoRapidWindComes) {
  listen();
  TempestOptions weak = options();
  weak.rapid_wind_interval_s = 0.0;
  TempestSimulator hub(weak, still_wind());
  run(hub, 302.0);
  ASSERT_EQ(sink.readings.size(), 4U) << "of five observations, the first of which may stand beside rapid winds";
  EXPECT_NEAR(sink.readings.back().speed_m_s, kTempestWind.speed_m_s, 1e-9);
  EXPECT_NEAR(sink.readings.back().gust_m_s.value(), kTempestWind.speed_m_s, 1e-9);
}

TEST_F(TempestDriver, DoesNotMixMeanWindsIntoRapidOnes) {
  listen();
  TempestSimulator hub(options(), still_wind());
  run(hub, 302.0);
  EXPECT_EQ(sink.readings.size(), 101U);
  for (const wind::Reading& reading : sink.readings) EXPECT_FALSE(reading.gust_m_s.has_value());
}

TEST_F(TempestDriver, HandsOnWhatElseTheStationMeasures) {
  listen();
  TempestSimulator hub(options(), still_wind());
  run(hub, 122.0);
  ASSERT_EQ(sink.station_quantities.size(), 2U);
  const wind::StationQuantities& said = sink.station_quantities.back();
  EXPECT_EQ(said.pressure_hpa, 1017.57);
  EXPECT_EQ(said.air_temperature_c, 22.37);
  EXPECT_EQ(said.relative_humidity_percent, 50.26);
  EXPECT_NEAR(said.rain_rate_mm_h.value(), 0.6, 1e-9);
  EXPECT_NE(said.time.mono, MonoTime{});
}

TEST_F(TempestDriver, TakesAMessageOnceThatItHearsTwice) {
  listen();
  hear(rapid_wind_of("ST-00000001", 0));
  hear(rapid_wind_of("ST-00000001", 0));
  hear(rapid_wind_of("ST-00000001", 3));
  hear(rapid_wind_of("ST-00000001", 3));
  EXPECT_EQ(sink.readings.size(), 2U);
  EXPECT_TRUE(sink.refusals.empty());

  // The hub's clock may be set back.
  hear(rapid_wind_of("ST-00000001", -100));
  EXPECT_EQ(sink.readings.size(), 3U);
}

/// A Tempest whose battery is nearly empty says its wind every five minutes.
TEST_F(TempestDriver, LearnsThatAStationSpeaksRarely) {
  listen();
  for (int minutes = 0; minutes <= 15; minutes += 5) {
    hear(rapid_wind_of("ST-00000001", 60 * minutes));
    clock_.advance(4min);
    idle();
    const bool knows = minutes >= 10;
    EXPECT_EQ(sink.last_state(), knows ? wind::LinkState::kConnected : wind::LinkState::kConnecting);
    clock_.advance(1min);
  }
  idle(25min);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting);
}

TEST_F(TempestDriver, RefusesAFlood) {
  listen();
  for (int i = 0; i < 150; ++i) hear(rapid_wind_of("ST-00000001", i));
  EXPECT_EQ(sink.readings.size(), 100U);
  EXPECT_EQ(sink.count(decode::Refusal::kTooFrequent), 50);
}

TEST_F(TempestDriver, HearsOnlyWhomItIsTold) {
  listen({{"from", std::string("192.0.2.1")}});
  sender_.send(rapid_wind_of("ST-00000001", 0), port_);
  for (int polls = 0; polls < 240 && sink.refusals.empty(); ++polls) idle();
  EXPECT_EQ(sink.count(decode::Refusal::kNotMine), 1);
  EXPECT_TRUE(sink.readings.empty());
}

/// Another program on this machine, as a second sensor here, hears the same broadcasts.
TEST_F(TempestDriver, SharesItsPortWithOthers) {
  listen({{"serial_number", std::string("ST-00000001")}});
  const auto other = driver_named("tempest").open(
      values_for("tempest", {{"port", std::int64_t{port_}}, {"serial_number", std::string("ST-00000002")}}));
  RecordingSink others;
  other->poll(clock_, others);
  for (int i = 0; i < 3; ++i) {
    sender_.send(rapid_wind_of("ST-00000001", i), port_, "127.255.255.255");
    sender_.send(rapid_wind_of("ST-00000002", i), port_, "127.255.255.255");
  }
  ASSERT_TRUE(take(6)) << sink.last_detail();
  for (int polls = 0; polls < 240 && others.raws.size() < 6; ++polls) other->poll(clock_, others);
  EXPECT_EQ(sink.readings.size(), 3U);
  EXPECT_EQ(others.readings.size(), 3U) << others.last_detail();
}

TEST_F(TempestDriver, DoesNotShareWithAProgramThatHasThePortToItself) {
  const LoopbackPort taken(SOCK_DGRAM);
  listen({{"port", std::int64_t{taken.port()}}, {"host", std::string("127.0.0.1")}});
  EXPECT_THAT(sink.last_detail(), HasSubstr("another program uses this port"));
}

TEST(TempestSettings, AreChecked) {
  const auto open_with = [](const char* key, const std::string& value) {
    return [=] { driver_named("tempest").open(values_for("tempest", {{key, value}})); };
  };
  EXPECT_THAT(open_with("from", "hub"), ThrowsMessage<std::runtime_error>(HasSubstr("from: \"hub\" is neither")));
  EXPECT_THAT(open_with("host", "hub"),
              ThrowsMessage<std::runtime_error>(HasSubstr("host: \"hub\" is not an address")));
}

TEST(TempestSettings, ShareThePort) {
  const auto endpoints = driver_named("tempest").endpoints(values_for("tempest", {}));
  ASSERT_EQ(endpoints.size(), 1U);
  EXPECT_EQ(endpoints[0].claim, "UDP port 50222");
  EXPECT_TRUE(endpoints[0].is_shared);
}

}  // namespace
}  // namespace yuragi::drivers::network
