#include "drivers/modbus/modbus_sensor.hpp"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/fake_modbus_line.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"

namespace yuragi::drivers::modbus {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

/// Cup on slave 1, vane on slave 2, asked four times a second.
Profile pair_profile() {
  Profile profile;
  profile.name = "pair";
  profile.poll_interval = 250ms;
  profile.min_gap = 20ms;
  profile.speed.scale = 0.1;
  profile.direction = decode::modbus::Quantity{};
  profile.direction->slave = 2;
  profile.direction->address = 1;
  profile.direction->unit = decode::modbus::QuantityUnit::kDegrees;
  return profile;
}

class ModbusSensorTest : public testing::Test {
 protected:
  ModbusSensorTest() {
    line_.statuses = [](const decode::modbus::Request&) { return std::deque{bus::Status::kMessage}; };
    line_.message = [](const decode::modbus::Request& request) {
      return reply_with(request, {static_cast<std::uint16_t>(request.unit == 1 ? 86 : 270)});
    };
  }

  void make(const Profile& profile) {
    bus::ModbusLine where;
    where.host = "here";
    auto bus = std::make_shared<Bus>(where, std::make_unique<FakeConnection>(line_));
    sensor_ = std::make_unique<Sensor>(profile, std::move(bus), nullptr, 1);
  }
  /// Polls once, when it is due.
  Nanoseconds poll() {
    clock_.advance_to(due_);
    due_ = sensor_->poll(clock_, sink_);
    return due_ - clock_.now().mono;
  }
  void poll_for(Nanoseconds duration) {
    const MonoTime end = clock_.now().mono + duration;
    while (due_ < end) poll();
  }

  FakeLine line_;
  ManualClock clock_;
  RecordingSink sink_;
  std::unique_ptr<Sensor> sensor_;
  MonoTime due_{};
};

TEST_F(ModbusSensorTest, PublishesOneReadingARoundFromBothSlaves) {
  make(pair_profile());
  poll();  // opens
  poll();  // speed
  EXPECT_TRUE(sink_.readings.empty());
  poll();  // direction
  ASSERT_EQ(sink_.readings.size(), 1U);
  EXPECT_DOUBLE_EQ(sink_.readings[0].speed_m_s, 8.6);
  EXPECT_EQ(sink_.readings[0].direction_deg, 270.0);
  EXPECT_EQ(sink_.readings[0].quality, wind::ReadingQuality::kGood);
  EXPECT_TRUE(sink_.refusals.empty());
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnected);
}

TEST_F(ModbusSensorTest, TimesAReadingWhenItsSpeedArrived) {
  make(pair_profile());
  poll();
  poll();
  const Instant arrived = clock_.now();
  poll();
  ASSERT_EQ(sink_.readings.size(), 1U);
  EXPECT_EQ(sink_.readings[0].time.mono, arrived.mono);
  EXPECT_EQ(sink_.readings[0].time.utc, arrived.utc);
}

TEST_F(ModbusSensorTest, KeepsTheGapBetweenRequestsAndThePaceOfRounds) {
  make(pair_profile());
  EXPECT_EQ(poll(), 0ms);
  EXPECT_EQ(poll(), 20ms);   // to the direction
  EXPECT_EQ(poll(), 230ms);  // to the next round, 250 ms after the beginning of this one
}

TEST_F(ModbusSensorTest, DoesNothingBeforeItIsDue) {
  make(pair_profile());
  poll();
  poll();
  const auto requests = line_.requests.size();
  EXPECT_EQ(sensor_->poll(clock_, sink_), due_);
  EXPECT_EQ(line_.requests.size(), requests);
}

TEST_F(ModbusSensorTest, GivesEachRequestATransactionOfItsOwn) {
  make(pair_profile());
  poll_for(1s);
  ASSERT_GT(line_.requests.size(), 4U);
  for (std::size_t i = 1; i < line_.requests.size(); ++i) {
    EXPECT_EQ(line_.requests[i].transaction, line_.requests[i - 1].transaction + 1);
  }
}

TEST_F(ModbusSensorTest, PassesOverALateAnswerAndTakesTheRightOne) {
  make(pair_profile());
  line_.statuses = [](const decode::modbus::Request&) {
    return std::deque{bus::Status::kMessage, bus::Status::kMessage};
  };
  bool is_late = true;
  line_.message = [&is_late](decode::modbus::Request request) {
    std::vector<std::uint16_t> registers = {86};
    if (std::exchange(is_late, !is_late)) {
      --request.transaction;
      registers = {999};
    }
    return reply_with(request, registers);
  };
  Profile profile = pair_profile();
  profile.direction.reset();
  make(profile);
  poll();
  poll();
  ASSERT_EQ(sink_.readings.size(), 1U);
  EXPECT_DOUBLE_EQ(sink_.readings[0].speed_m_s, 8.6);
  EXPECT_THAT(sink_.refusals, ElementsAre(decode::Refusal::kNotMine));
}

TEST_F(ModbusSensorTest, CountsAnAnswerOfAnotherSlaveOnceAndNotItsSilenceBesides) {
  make(pair_profile());
  line_.message = [](decode::modbus::Request request) {
    request.unit = 9;
    return reply_with(request, {86});
  };
  poll();
  poll();
  EXPECT_TRUE(sink_.readings.empty());
  EXPECT_THAT(sink_.refusals, ElementsAre(decode::Refusal::kNotMine));
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnecting);
}

TEST_F(ModbusSensorTest, CountsEachFailureAsWhatItIsAndPublishesNothing) {
  const std::vector<std::pair<bus::Status, decode::Refusal>> failures = {
      {bus::Status::kSilence, decode::Refusal::kTimeout},
      {bus::Status::kCutOff, decode::Refusal::kTooShort},
      {bus::Status::kGarbled, decode::Refusal::kMalformed}};
  for (const auto& [status, why] : failures) {
    make(pair_profile());
    sink_ = {};
    line_.statuses = [one = status](const decode::modbus::Request&) { return std::deque{one}; };
    poll();
    poll();
    EXPECT_THAT(sink_.refusals, ElementsAre(why));
    EXPECT_TRUE(sink_.readings.empty());
    EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnecting);
  }
}

TEST_F(ModbusSensorTest, SaysWhichExceptionAndWhatToDo) {
  make(pair_profile());
  line_.message = [](const decode::modbus::Request& request) {
    auto bytes = reply_with(request, {});
    bytes[7] = 0x83;
    bytes[8] = 2;
    return bytes;
  };
  poll();
  poll();
  EXPECT_THAT(sink_.refusals, ElementsAre(decode::Refusal::kException));
  EXPECT_THAT(sink_.last_detail(),
              HasSubstr("slave 1 at here:502 refuses the request (exception 2, illegal data address)"));
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(ModbusSensorTest, RefusesAnImplausibleSpeedAndAsksNoDirectionForIt) {
  make(pair_profile());
  line_.message = [](const decode::modbus::Request& request) { return reply_with(request, {9999}); };
  poll();
  poll();
  EXPECT_THAT(sink_.refusals, ElementsAre(decode::Refusal::kImplausible));
  EXPECT_TRUE(sink_.readings.empty());
  EXPECT_EQ(line_.requests.size(), 1U);
}

TEST_F(ModbusSensorTest, PublishesTheSpeedAloneWhileTheVaneIsSilentAndAsksItLessOften) {
  make(pair_profile());
  line_.statuses = [](const decode::modbus::Request& request) {
    return request.unit == 1 ? std::deque{bus::Status::kMessage} : std::deque<bus::Status>{};
  };
  poll_for(60s);
  EXPECT_GE(sink_.readings.size(), 235U);
  for (const wind::Reading& reading : sink_.readings) EXPECT_FALSE(reading.direction_deg.has_value());
  const auto vane_requests = std::ranges::count(line_.requests, 2, &decode::modbus::Request::unit);
  EXPECT_EQ(sink_.count(decode::Refusal::kTimeout), vane_requests);
  EXPECT_GE(vane_requests, 6);
  EXPECT_LE(vane_requests, 15);
  EXPECT_EQ(line_.opened, 1);
  EXPECT_THAT(sink_.last_detail(), HasSubstr("without direction: slave 2 at here:502 does not reply"));
}

TEST_F(ModbusSensorTest, HasTheDirectionAgainWhenTheVaneIsBack) {
  make(pair_profile());
  bool vane_replies = false;
  line_.statuses = [&](const decode::modbus::Request& request) {
    return request.unit == 1 || vane_replies ? std::deque{bus::Status::kMessage} : std::deque<bus::Status>{};
  };
  poll_for(30s);
  vane_replies = true;
  poll_for(11s);
  EXPECT_EQ(sink_.readings.back().direction_deg, 270.0);
  EXPECT_EQ(sink_.last_detail(), "pair at here:502");
}

TEST_F(ModbusSensorTest, PublishesTheSpeedAloneWhereTheDirectionIsInvalid) {
  Profile profile = pair_profile();
  profile.direction->invalid = {270};
  make(profile);
  poll_for(1s);
  ASSERT_FALSE(sink_.readings.empty());
  EXPECT_FALSE(sink_.readings.back().direction_deg.has_value());
  EXPECT_EQ(sink_.count(decode::Refusal::kInvalid), std::ssize(sink_.readings));
}

TEST_F(ModbusSensorTest, TriesToOpenForEverWithWaitsThatGrowTo10Seconds) {
  make(pair_profile());
  line_.can_open = false;
  std::vector<Nanoseconds> waits(100);
  for (Nanoseconds& wait : waits) wait = poll();
  EXPECT_EQ(line_.opened, 100);
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnecting);
  EXPECT_EQ(sink_.last_detail(), "cannot open the fake");
  EXPECT_LE(waits.front(), 250ms);
  for (const Nanoseconds wait : waits) {
    EXPECT_GE(wait, 187ms);
    EXPECT_LE(wait, 10s);
  }
  for (std::size_t i = 10; i < waits.size(); ++i) EXPECT_GE(waits[i], 7500ms);

  line_.can_open = true;
  poll_for(11s);
  EXPECT_FALSE(sink_.readings.empty());
}

TEST_F(ModbusSensorTest, OpensAgainAfterThreeSilentRequestsInARow) {
  make(pair_profile());
  line_.statuses = [](const decode::modbus::Request&) { return std::deque<bus::Status>{}; };
  for (int i = 0; i < 4; ++i) poll();
  EXPECT_EQ(line_.opened, 1);
  poll();
  EXPECT_EQ(line_.opened, 2);
  EXPECT_EQ(sink_.count(decode::Refusal::kTimeout), 3);
}

TEST_F(ModbusSensorTest, OpensAgainWhenTheConnectionIsLostAndPublishesOn) {
  make(pair_profile());
  poll_for(1s);
  line_.statuses = [](const decode::modbus::Request&) { return std::deque{bus::Status::kLost}; };
  poll();
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnecting);
  line_.statuses = [](const decode::modbus::Request&) { return std::deque{bus::Status::kMessage}; };
  const auto before = sink_.readings.size();
  poll_for(1s);
  EXPECT_EQ(line_.opened, 2);
  EXPECT_GT(sink_.readings.size(), before);
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnected);
}

TEST_F(ModbusSensorTest, ReopeningAServerThatOnlyAcceptsGetsRarer) {
  make(pair_profile());
  line_.statuses = [](const decode::modbus::Request&) { return std::deque{bus::Status::kLost}; };
  poll_for(60s);
  EXPECT_LE(line_.opened, 13);
  EXPECT_GE(line_.opened, 9);
}

TEST_F(ModbusSensorTest, WaitsAfterOpeningAndBelievesNothingUntilTheDeviceIsWarm) {
  Profile profile = pair_profile();
  profile.delay_after_open = 2s;
  profile.warm_up = 10s;
  make(profile);
  EXPECT_EQ(poll(), 2s);
  const MonoTime opened = clock_.now().mono;
  poll_for(8s);
  EXPECT_GT(line_.requests.size(), 10U);
  EXPECT_TRUE(sink_.readings.empty());
  EXPECT_THAT(sink_.last_detail(), HasSubstr("is warming up"));
  poll_for(4s);
  ASSERT_FALSE(sink_.readings.empty());
  EXPECT_GE(sink_.readings.front().time.mono - opened, 10s);
}

TEST_F(ModbusSensorTest, ReadsAdjoiningRegistersOfOneSlaveAtOnce) {
  Profile profile = pair_profile();
  profile.direction->slave = 1;
  make(profile);
  line_.message = [](const decode::modbus::Request& request) { return reply_with(request, {86, 270}); };
  poll();
  poll();
  ASSERT_EQ(line_.requests.size(), 1U);
  EXPECT_EQ(line_.requests[0].address, 0);
  EXPECT_EQ(line_.requests[0].count, 2);
  ASSERT_EQ(sink_.readings.size(), 1U);
  EXPECT_DOUBLE_EQ(sink_.readings[0].speed_m_s, 8.6);
  EXPECT_EQ(sink_.readings[0].direction_deg, 270.0);
}

TEST_F(ModbusSensorTest, ReadsABlockThatBeginsWithTheDirection) {
  Profile profile = pair_profile();
  profile.direction->slave = 1;
  profile.direction->address = 2;
  profile.speed.address = 3;
  profile.speed.type = decode::modbus::RegisterType::kU32;
  make(profile);
  line_.message = [](const decode::modbus::Request& request) { return reply_with(request, {270, 0, 86}); };
  poll();
  poll();
  ASSERT_EQ(line_.requests.size(), 1U);
  EXPECT_EQ(line_.requests[0].address, 2);
  EXPECT_EQ(line_.requests[0].count, 3);
  ASSERT_EQ(sink_.readings.size(), 1U);
  EXPECT_DOUBLE_EQ(sink_.readings[0].speed_m_s, 8.6);
  EXPECT_EQ(sink_.readings[0].direction_deg, 270.0);
}

TEST_F(ModbusSensorTest, ReadsOneByOneWhereABlockIsNotAllowedOrPossible) {
  const std::vector<std::function<void(Profile&)>> obstacles = {
      [](Profile& profile) { profile.block_read = false; },
      [](Profile& profile) { profile.speed.read_has_side_effect = true; },
      [](Profile& profile) { profile.direction->read_has_side_effect = true; },
      [](Profile& profile) { profile.direction->function = 4; },
      [](Profile& profile) { profile.direction->address = 2; },
  };
  for (const auto& obstacle : obstacles) {
    Profile profile = pair_profile();
    profile.direction->slave = 1;
    obstacle(profile);
    make(profile);
    line_.requests.clear();
    poll();
    poll();
    poll();
    ASSERT_EQ(line_.requests.size(), 2U);
    EXPECT_EQ(line_.requests[0].count, 1);
    EXPECT_EQ(line_.requests[1].count, 1);
  }
}

TEST_F(ModbusSensorTest, AddsTheNorthOffsetAroundTheCircle) {
  for (const auto& [offset_deg, expected_deg] : {std::pair{100.0, 10.0}, {-280.0, 350.0}, {90.0, 0.0}}) {
    Profile profile = pair_profile();
    profile.north_offset_deg = offset_deg;
    make(profile);
    poll_for(1s);
    EXPECT_EQ(sink_.readings.back().direction_deg, expected_deg);
  }
}

TEST_F(ModbusSensorTest, CountsNothingForARequestThatWasInterrupted) {
  make(pair_profile());
  poll();
  sensor_->interrupt();
  poll();
  EXPECT_TRUE(sink_.refusals.empty());
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(ModbusSensorTest, PublishesAGustThatComesAlongOrByItself) {
  for (const std::uint16_t address : {std::uint16_t{1}, std::uint16_t{40}}) {
    Profile profile = pair_profile();
    profile.gust = profile.speed;
    profile.gust->address = address;
    make(profile);
    sink_ = {};
    line_.message = [](const decode::modbus::Request& request) {
      std::vector<std::uint16_t> registers(request.count, static_cast<std::uint16_t>(request.unit == 1 ? 86 : 270));
      if (request.unit == 1 && (request.count == 2 || request.address == 40)) registers.back() = 121;
      return reply_with(request, registers);
    };
    poll_for(1s);
    ASSERT_FALSE(sink_.readings.empty());
    EXPECT_DOUBLE_EQ(sink_.readings.back().speed_m_s, 8.6);
    EXPECT_DOUBLE_EQ(sink_.readings.back().gust_m_s.value(), 12.1);
    EXPECT_EQ(sink_.readings.back().direction_deg, 270.0);
    EXPECT_TRUE(sink_.refusals.empty());
  }
}

TEST_F(ModbusSensorTest, GoesOnWithoutAGustThatIsNoneAndSaysSo) {
  Profile profile = pair_profile();
  profile.gust = profile.speed;
  profile.gust->address = 40;
  profile.gust->max = 5.0;
  make(profile);
  poll_for(1s);
  ASSERT_FALSE(sink_.readings.empty());
  EXPECT_FALSE(sink_.readings.back().gust_m_s.has_value());
  EXPECT_EQ(sink_.count(decode::Refusal::kImplausible), std::ssize(sink_.readings));
  EXPECT_EQ(sink_.last_detail(), "pair at here:502; without gust: it is implausible");
}

TEST_F(ModbusSensorTest, AsksADeadSpeedSlaveLessAndLessOften) {
  make(pair_profile());
  line_.statuses = [](const decode::modbus::Request&) { return std::deque<bus::Status>{}; };
  poll_for(60s);
  EXPECT_GE(line_.requests.size(), 6U);
  EXPECT_LE(line_.requests.size(), 15U);
}

TEST_F(ModbusSensorTest, KeepsItsPaceThroughNoiseThatLetsAReplyThrough) {
  Profile profile = pair_profile();
  profile.direction.reset();
  make(profile);
  bool is_damaged = true;
  line_.message = [&is_damaged](const decode::modbus::Request& request) {
    auto bytes = reply_with(request, {86});
    if (is_damaged) bytes[7] = 4;  // another function
    is_damaged = !is_damaged;
    return bytes;
  };
  poll_for(10s);
  EXPECT_GE(sink_.count(decode::Refusal::kMalformed), 18);
  EXPECT_GE(sink_.readings.size(), 18U);
}

TEST_F(ModbusSensorTest, TellsAGatewaysSilentSlaveFromARefusal) {
  make(pair_profile());
  line_.message = [](const decode::modbus::Request& request) {
    auto bytes = reply_with(request, {});
    bytes[7] = 0x83;
    bytes[8] = 11;
    return bytes;
  };
  poll_for(60s);
  EXPECT_THAT(sink_.last_detail(), HasSubstr("the gateway reports that slave 1 at here:502 does not reply"));
  EXPECT_LE(line_.requests.size(), 15U);
}

TEST_F(ModbusSensorTest, OpensTheLineAgainThatAnotherSensorHasLost) {
  bus::ModbusLine where;
  where.host = "here";
  auto bus = std::make_shared<Bus>(where, std::make_unique<FakeConnection>(line_));
  Profile cup = pair_profile();
  cup.direction.reset();
  Sensor one(cup, bus, nullptr, 1);
  Sensor other(cup, bus, nullptr, 2);
  RecordingSink other_sink;
  const auto poll_both = [&] {
    clock_.advance(250ms);
    one.poll(clock_, sink_);
    other.poll(clock_, other_sink);
  };
  for (int i = 0; i < 4; ++i) poll_both();
  EXPECT_EQ(line_.opened, 1);

  bool loses = true;
  line_.statuses = [&loses](const decode::modbus::Request&) {
    return std::deque{std::exchange(loses, false) ? bus::Status::kLost : bus::Status::kMessage};
  };
  for (int i = 0; i < 8; ++i) poll_both();
  EXPECT_EQ(line_.opened, 2);
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnected);
  EXPECT_EQ(other_sink.last_state(), wind::LinkState::kConnected);
  EXPECT_EQ(other_sink.links.size(), 1U) << "nothing was wrong with the other one";
}

/// A station with the speed in register 10 of slave 1, the humidity beside it, the pressure in 40, every 10 s.
Profile station_profile() {
  Profile profile;
  profile.name = "station";
  profile.poll_interval = 500ms;
  profile.min_gap = 20ms;
  profile.speed.address = 10;
  profile.speed.scale = 0.1;
  const auto add = [&profile](const wind::StationQuantity& what, std::uint16_t address, double scale) {
    StationQuantity station{.what = what, .quantity = {}};
    station.quantity.address = address;
    station.quantity.scale = scale;
    station.quantity.invalid = {0xFFFF};
    profile.quantities.push_back(station);
  };
  for (const wind::StationQuantity& what : wind::kStationQuantities) {
    if (what.name == "relative_humidity_percent") add(what, 11, 1.0);
    if (what.name == "pressure_hpa") add(what, 40, 0.1);
  }
  return profile;
}

/// Speed 8.6 m/s, humidity 64 %, pressure 1009.2 hPa.
std::vector<std::uint8_t> station_reply(const decode::modbus::Request& request) {
  if (request.address == 40) return reply_with(request, {10092});
  return reply_with(request, {86, 64});
}

TEST_F(ModbusSensorTest, PublishesWhatAStationSaysBesidesTheWindOnceInItsInterval) {
  line_.message = station_reply;
  make(station_profile());
  poll_for(19s);
  EXPECT_GE(sink_.readings.size(), 37U) << "the wind keeps its pace";
  ASSERT_EQ(sink_.station_quantities.size(), 2U);
  for (const wind::StationQuantities& said : sink_.station_quantities) {
    EXPECT_EQ(said.relative_humidity_percent, 64.0);
    EXPECT_NEAR(said.pressure_hpa.value(), 1009.2, 1e-9);
    EXPECT_FALSE(said.air_temperature_c.has_value());
  }
  EXPECT_GE(sink_.station_quantities[1].time.mono - sink_.station_quantities[0].time.mono, 10s);
  EXPECT_TRUE(sink_.refusals.empty());
}

TEST_F(ModbusSensorTest, AsksForTheRestOnlyAfterTheWindWasPublished) {
  line_.message = station_reply;
  make(station_profile());
  poll();  // opens
  poll();  // speed and humidity
  ASSERT_EQ(sink_.readings.size(), 1U);
  EXPECT_EQ(line_.requests.size(), 1U);
  EXPECT_TRUE(sink_.station_quantities.empty());
  const Nanoseconds pause = poll();  // pressure
  EXPECT_EQ(line_.requests.back().address, 40);
  EXPECT_EQ(sink_.station_quantities.size(), 1U);
  EXPECT_EQ(pause, 480ms) << "the next round begins 500 ms after this one";
}

TEST_F(ModbusSensorTest, AsksLessAndLessForWhatAStationDoesNotHave) {
  line_.message = station_reply;
  line_.statuses = [](const decode::modbus::Request& request) {
    return request.address == 40 ? std::deque<bus::Status>{} : std::deque{bus::Status::kMessage};
  };
  make(station_profile());
  poll_for(1h);
  const auto asked = std::ranges::count(line_.requests, 40, &decode::modbus::Request::address);
  EXPECT_GE(asked, 6);
  EXPECT_LE(asked, 16) << "10, 20, 40 ... 600 s, less a quarter";
  EXPECT_GE(sink_.readings.size(), 7100U);
  EXPECT_THAT(sink_.last_detail(), HasSubstr("without pressure_hpa: slave 1"));
  ASSERT_FALSE(sink_.station_quantities.empty());
  EXPECT_EQ(sink_.station_quantities.back().relative_humidity_percent, 64.0) << "what it has goes on";
}

TEST_F(ModbusSensorTest, SaysNothingOfAQuantityThatIsMarkedAsNone) {
  line_.message = [](const decode::modbus::Request& request) {
    return request.address == 40 ? reply_with(request, {0xFFFF}) : reply_with(request, {86, 0xFFFF});
  };
  make(station_profile());
  poll_for(25s);
  EXPECT_TRUE(sink_.station_quantities.empty());
  EXPECT_TRUE(sink_.refusals.empty());
  EXPECT_GE(sink_.readings.size(), 49U);
}

TEST_F(ModbusSensorTest, LeavesOutWhatNoAirIs) {
  line_.message = [](const decode::modbus::Request& request) {
    return request.address == 40 ? reply_with(request, {10092}) : reply_with(request, {86, 640});  // 640 %
  };
  make(station_profile());
  poll_for(3s);
  ASSERT_EQ(sink_.station_quantities.size(), 1U);
  EXPECT_FALSE(sink_.station_quantities[0].relative_humidity_percent.has_value());
  EXPECT_TRUE(sink_.station_quantities[0].pressure_hpa.has_value());
}

}  // namespace
}  // namespace yuragi::drivers::modbus
