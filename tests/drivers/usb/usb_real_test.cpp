// The drivers `hid` and `usb` with the real hidapi and libusb, on simulated devices in a testbed of umockdev's: what is
// said is the wind that is played, and after each fault it is said again.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/sensor/driver.hpp"
#include "simulators/usb/daqs.hpp"
#include "simulators/usb/hid_stations.hpp"
#include "simulators/usb/umockdev_simulator.hpp"
#include "tests/simulators/usb/steady_wind.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/live_sensor.hpp"
#include "tests/support/simulator_thread.hpp"

namespace yuragi::drivers::usb {
namespace {

using namespace std::chrono_literals;
using simulators::core::FaultKind;
using simulators::usb::steady_wind;

constexpr double kPlayed_m_s = 8.6;
constexpr double kPlayed_deg = 225.0;
constexpr double kPace = 40.0;  // of the stations: a Fine Offset says its wind every 1.2 s and not every 48 s

std::unique_ptr<sensor::Sensor> open_real(std::string_view driver_name, const ParameterValues::Map& given) {
  const sensor::DriverDescription& driver = driver_named(driver_name);
  return driver.open(*ParameterValues::resolve(driver.parameters, given));
}

std::unique_ptr<simulators::core::Simulator> plugged_in(std::unique_ptr<simulators::usb::Device> device) {
  std::vector<std::unique_ptr<simulators::usb::Port>> ports;
  ports.push_back(std::make_unique<simulators::usb::Port>(std::move(device),
                                                          simulators::usb::steady_wind(kPlayed_m_s, kPlayed_deg)));
  return std::make_unique<simulators::usb::UmockdevSimulator>(std::move(ports));
}

bool can_suffer(const simulators::usb::Device& device, FaultKind kind) {
  return kind == FaultKind::kSilence || kind == FaultKind::kUnplug ||
         std::ranges::count(device.known_faults(), kind) != 0;
}

struct PluggedIn {
  explicit PluggedIn(std::unique_ptr<simulators::usb::Device> device) : simulator(plugged_in(std::move(device))) {}
  SimulatorThread simulator;
};

/// One device, its driver, and how far a reading may be from the wind that is played. The driver ends before the
/// device.
struct RealBench : PluggedIn, test::LiveSensor {
  RealBench(std::unique_ptr<simulators::usb::Device> device, std::unique_ptr<sensor::Sensor> sensor, double tolerance)
      : PluggedIn(std::move(device)), test::LiveSensor(std::move(sensor)), tolerance_m_s(tolerance) {}

  void expect_the_played_wind() const {
    ASSERT_FALSE(sink.readings.empty());
    double sum_m_s = 0.0;
    for (const wind::Reading& reading : sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, kPlayed_m_s, tolerance_m_s);
      EXPECT_NEAR(reading.direction_deg.value_or(kPlayed_deg), kPlayed_deg, 2.0);
      sum_m_s += reading.speed_m_s;
    }
    EXPECT_NEAR(sum_m_s / static_cast<double>(sink.readings.size()), kPlayed_m_s, 0.1 * kPlayed_m_s);
    EXPECT_TRUE(
        std::ranges::any_of(sink.readings, [](const wind::Reading& one) { return one.direction_deg.has_value(); }));
  }

  /// The device suffers, which is told in time; nothing false is published; the readings return by themselves.
  void expect_it_suffers_and_returns(FaultKind kind) {
    ASSERT_TRUE(wait_for_readings(2));
    ASSERT_EQ(sink.last_state(), wind::LinkState::kConnected);
    const std::size_t refusals_before = sink.refusals.size();
    simulator.set_fault(kind);
    ASSERT_TRUE(wait_until([&] { return sink.last_state() == wind::LinkState::kConnecting; }));
    EXPECT_FALSE(sink.last_detail().empty());
    const std::size_t readings_before = sink.readings.size();
    listen_for(300ms);
    EXPECT_TRUE(kind == FaultKind::kUnplug || wait_until([&] { return sink.refusals.size() > refusals_before; }));
    EXPECT_EQ(sink.readings.size(), readings_before);

    simulator.set_fault(std::nullopt);
    ASSERT_TRUE(wait_for_readings(2));
    EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
    expect_the_played_wind();
  }

  double tolerance_m_s;
};

// ---- hid ----

RealBench station_bench(std::string_view name) {
  return {simulators::usb::make_hid_station(name, kPace), open_real("hid", {{"pace", kPace}}), 0.15};
}

/// A fault, with those of the stations that can suffer it.
void expect_stations_suffer(FaultKind kind, const std::vector<std::string_view>& names) {
  for (const std::string_view name : names) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(can_suffer(*simulators::usb::make_hid_station(name), kind));
    RealBench bench = station_bench(name);
    bench.expect_it_suffers_and_returns(kind);
  }
}

class HidReal : public testing::TestWithParam<std::string_view> {};

TEST_P(HidReal, SaysTheWindThatIsPlayed) {
  RealBench bench = station_bench(GetParam());
  ASSERT_TRUE(bench.wait_for_readings(2));
  bench.expect_the_played_wind();
  EXPECT_THAT(bench.sink.last_detail(), testing::HasSubstr("USB port 1-1"));
}

TEST_P(HidReal, IsFoundAndCanBeOpened) {
  const SimulatorThread simulator(plugged_in(simulators::usb::make_hid_station(GetParam())));
  const std::vector<sensor::FoundDevice> found = driver_named("hid").find();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].trouble, "");
  EXPECT_THAT(found[0].settings, testing::HasSubstr("path = \"1-1\""));
}

std::string test_name(std::string name) {
  std::ranges::replace(name, '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Every, HidReal, testing::ValuesIn(simulators::usb::hid_station_names()),
                         [](const auto& test) { return test_name(std::string(test.param)); });

// Two that speak by themselves and two that are asked, over the interrupt end point and by GET_REPORT; every fault of
// every station is tried without these libraries in hid_fault_test.cpp.

TEST(HidRealFault, Silence) {
  expect_stations_suffer(FaultKind::kSilence, {"wmr300", "te923"});
}

TEST(HidRealFault, Garbage) {
  expect_stations_suffer(FaultKind::kGarbage, {"wmr300", "acurite"});
}

TEST(HidRealFault, BadChecksum) {
  expect_stations_suffer(FaultKind::kBadChecksum, {"wmr100", "te923"});
}

TEST(HidRealFault, Unplug) {
  expect_stations_suffer(FaultKind::kUnplug, {"wmr100", "wmr300", "acurite"});
}

// ---- usb ----

/// A cup says a whole number of pulses in the time between two samples, which is never quite the same.
RealBench daq_bench(const std::string& name) {
  return {simulators::usb::make_daq(name), open_real("usb", {{"window_pulses", std::int64_t{16}}}), 2.5};
}

void expect_daqs_suffer(FaultKind kind) {
  int suffering = 0;
  for (const std::string& name : simulators::usb::daq_names()) {
    if (!can_suffer(*simulators::usb::make_daq(name), kind)) continue;
    SCOPED_TRACE(name);
    ++suffering;
    RealBench bench = daq_bench(name);
    bench.expect_it_suffers_and_returns(kind);
  }
  EXPECT_GT(suffering, 0);
}

class UsbReal : public testing::TestWithParam<std::string> {};

TEST_P(UsbReal, SaysTheWindThatIsPlayed) {
  RealBench bench = daq_bench(GetParam());
  ASSERT_TRUE(bench.wait_for_readings(6));
  bench.expect_the_played_wind();
}

TEST_P(UsbReal, IsFoundAndCanBeOpened) {
  const SimulatorThread simulator(plugged_in(simulators::usb::make_daq(GetParam())));
  const std::vector<sensor::FoundDevice> found = driver_named("usb").find();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].trouble, "");
}

INSTANTIATE_TEST_SUITE_P(Every, UsbReal, testing::ValuesIn(simulators::usb::daq_names()),
                         [](const auto& test) { return test_name(test.param); });

TEST(UsbRealFault, Silence) {
  expect_daqs_suffer(FaultKind::kSilence);
}

TEST(UsbRealFault, Garbage) {
  expect_daqs_suffer(FaultKind::kGarbage);
}

TEST(UsbRealFault, Partial) {
  expect_daqs_suffer(FaultKind::kPartial);
}

TEST(UsbRealFault, BadChecksum) {
  expect_daqs_suffer(FaultKind::kBadChecksum);
}

TEST(UsbRealFault, WrongTransaction) {
  expect_daqs_suffer(FaultKind::kWrongTransaction);
}

TEST(UsbRealFault, Late) {
  expect_daqs_suffer(FaultKind::kLate);
}

TEST(UsbRealFault, Exception) {
  expect_daqs_suffer(FaultKind::kException);
}

TEST(UsbRealFault, Unplug) {
  expect_daqs_suffer(FaultKind::kUnplug);
}

}  // namespace
}  // namespace yuragi::drivers::usb
