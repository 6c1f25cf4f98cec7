// What a device of Lufft's and its line can do wrong, and what the driver makes of it: with a simulated station at the
// other end of a real pseudo terminal or TCP connection.
#include <memory>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/lufft/umb_sensor.hpp"
#include "simulators/lufft/umb_station.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/station_fault.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::lufft {
namespace {

using simulators::core::FaultKind;
using simulators::lufft::UmbStation;
using simulators::lufft::UmbStationOptions;
using testing::HasSubstr;

class UmbFault : public StationFault {
 protected:
  UmbFault() : StationFault(7.25, 1.0) {}

  enum class Wire { kPty, kTcp };

  void connect(Wire wire, const UmbStationOptions& options = {}) {
    bench_.put(nullptr, nullptr);  // the name of the port is free again
    const std::string link = (folder_ / "station").string();
    auto carried = wire == Wire::kPty ? simulators::text::make_pty_wire(link)
                                      : simulators::text::make_tcp_wire("127.0.0.1", free_port(SOCK_STREAM));
    const std::string place = carried->place();
    ParameterValues::Map given = {
        {"device", link}, {"class", std::int64_t{options.device_class}}, {"id", std::int64_t{options.id}}};
    if (wire == Wire::kTcp) {
      given["transport"] = std::string("tcp");
      given["host"] = std::string("127.0.0.1");
      given["port"] = std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))};
    }
    auto station = std::make_unique<UmbStation>(bench_.observed(std::move(carried)), options, still_wind());
    const UmbSettings settings = umb_settings_of(values_for("umb", given));
    bench_.put(std::move(station), std::make_unique<UmbSensor>(settings, bench_.port(settings.address)));
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(UmbFault, WithoutAnyNothingIsLost) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire, {.id = 9, .echoes = wire == Wire::kPty});
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(30.0);
    EXPECT_GE(bench_.sink.readings.size(), 28U);
    EXPECT_TRUE(bench_.sink.refusals.empty()) << "an echo is no reply, and nothing wrong";
    expect_only_the_wind();
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("Lufft 7009h at "));
    const wind::StationQuantities& said = bench_.sink.station_quantities.back();
    EXPECT_EQ(bench_.sink.readings.back().gust_m_s, 7.25);
    EXPECT_EQ(said.air_temperature_c, 14.5);
    EXPECT_EQ(said.relative_humidity_percent, 65.0);
    EXPECT_EQ(said.pressure_hpa, 1013.25);
    EXPECT_EQ(said.rain_total_mm, 7.5);
    EXPECT_EQ(said.rain_rate_mm_h, 3.0);
  }
}

TEST_F(UmbFault, WithoutAnyAVentusIsReadToo) {
  connect(Wire::kTcp, {.device_class = 8, .has_fast_channels = false, .measures_more = false});
  expect_return();
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("Lufft 8001h at "));
}

/// It is asked for speed and direction alone.
TEST_F(UmbFault, ExceptionToALongQueryIsFollowedByAShortOne) {
  connect(Wire::kPty, {.refuses_long_query = true});
  ASSERT_TRUE(is_live());
  EXPECT_EQ(bench_.sink.count(decode::Refusal::kException), 1);
  bench_.run(10.0);
  EXPECT_GE(bench_.sink.readings.size(), 9U);
  EXPECT_TRUE(bench_.sink.refusals.empty());
  EXPECT_EQ(bench_.sink.readings.back().speed_m_s, 7.25);
  EXPECT_EQ(bench_.sink.readings.back().direction_deg, 123.0);
}

TEST_F(UmbFault, Silence) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    bench_.run(1.0);
    expect_no_wind(FaultKind::kSilence, 6.0, "does not reply: check its power");
    bench_.run(6.0, FaultKind::kSilence);
    EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 2);
    expect_return();
  }
}

TEST_F(UmbFault, Freeze) {
  connect(Wire::kPty);
  expect_freeze_is_published();
}

TEST_F(UmbFault, Spike) {
  connect(Wire::kPty);
  expect_spike_is_not_believed();
}

TEST_F(UmbFault, Garbage) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    expect_no_wind(FaultKind::kGarbage, 12.0, "replies arrive damaged");
    EXPECT_GE(bench_.sink.count(decode::Refusal::kMalformed), 3);
    expect_return();
  }
}

TEST_F(UmbFault, Split) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    bench_.run(10.0, FaultKind::kSplit);
    EXPECT_GE(bench_.sink.readings.size(), 9U);
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
    expect_return();
  }
}

TEST_F(UmbFault, Partial) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    expect_no_wind(FaultKind::kPartial, 12.0, "replies arrive damaged");
    EXPECT_GE(bench_.sink.count(decode::Refusal::kTooShort), 3);
    expect_return();
  }
}

TEST_F(UmbFault, BadChecksum) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    expect_no_wind(FaultKind::kBadChecksum, 12.0, "replies arrive damaged");
    EXPECT_GE(bench_.sink.count(decode::Refusal::kBadChecksum), 3);
    expect_return();
  }
}

TEST_F(UmbFault, WrongId) {
  connect(Wire::kPty);
  ASSERT_TRUE(is_live());
  expect_no_wind(FaultKind::kWrongId, 12.0, "a device other than Lufft 7001h replies");
  EXPECT_GE(bench_.sink.count(decode::Refusal::kNotMine), 3);
  expect_return();
}

TEST_F(UmbFault, Late) {
  connect(Wire::kPty);
  ASSERT_TRUE(is_live());
  bench_.run(20.0, FaultKind::kLate);
  EXPECT_TRUE(bench_.sink.readings.empty()) << "a late reply is not taken for that to another request";
  EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 4);
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
  expect_return();
}

TEST_F(UmbFault, Exception) {
  connect(Wire::kPty);
  ASSERT_TRUE(is_live());
  expect_no_wind(FaultKind::kException, 10.0, "refuses the query of its channels (status 11h)");
  EXPECT_GE(bench_.sink.count(decode::Refusal::kException), 9);
  expect_return();
}

TEST_F(UmbFault, Disconnect) {
  connect(Wire::kTcp);
  ASSERT_TRUE(is_live());
  expect_no_wind(FaultKind::kDisconnect, 5.0, "cannot connect to 127.0.0.1:");
  expect_return();
}

TEST_F(UmbFault, Unplug) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    bench_.run(6.0, FaultKind::kUnplug);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    expect_return();
  }
}

}  // namespace
}  // namespace yuragi::drivers::lufft
