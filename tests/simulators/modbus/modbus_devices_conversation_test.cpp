// Every device that has a profile, and several on one line: the real driver and the simulator, each with register
// tables of its own, over TCP and over a pseudo terminal; and mbpoll on the simulated serial line.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/modbus_programs.hpp"
#include "tests/support/running_sensor.hpp"

namespace yuragi::simulators::modbus {
namespace {

using namespace std::chrono_literals;
using Transport = test::ModbusSimulatorProgram::Transport;

const std::vector<std::string> kSteadyWind = {"--speed", "7", "--direction", "135", "--turbulence", "0"};

std::vector<std::string> steady(std::vector<std::string> more) {
  more.insert(more.end(), kSteadyWind.begin(), kSteadyWind.end());
  return more;
}

/// A device and what it can measure of 7 m/s from 135 degrees: all of it, to within its resolution.
struct PlayedDevice {
  const char* name;
  bool has_direction = true;
  bool has_gust = false;
  const char* quantities = "";  ///< which of "thpr" it says besides: temperature, humidity, pressure, rain

  friend void PrintTo(const PlayedDevice& device, std::ostream* out) { *out << device.name; }
};

const std::vector<PlayedDevice> kPlayedDevices = {
    {"renke-rs-fsjt-n01", false},
    {"renke-rs-fsjt-rs-fxjt-n01"},
    {"dfrobot-sen0483", false},
    {"dfrobot-sen0483-sen0482"},
    {"dfrobot-sen0483-sen0482-v1"},
    {"renke-multi-station", true, false, "thpr"},
    {"renke-multi-station-x100", true, false, "thpr"},
    {"ecowitt-wn90lp", true, true, "thpr"},
    {"seeed-sensecap-one", true, true, "thp"},
    {"calypso-ulp", true, true},
    {"lufft-umb", true, true, "thp"},
    {"vaisala-wm80", true, true},
    {"gill-maximet-gmx"},
    {"campbell-metsens200"},
    {"lambrecht-industry"},
    {"thies-clima-sensor-us", true, true, "thp"},
    {"xunchip-xm8589", false},
    {"generic-rs485-cup", false},
    {"generic-rs485-cup-0x16", false},
};

class PlayedDeviceTest : public testing::TestWithParam<PlayedDevice> {
 protected:
  /// The device says the wind that is played. A copy of its profile leaves out the time that it takes to warm up.
  static void expect_agreement(Transport transport) {
    const PlayedDevice& device = GetParam();
    test::ModbusSimulatorProgram simulator(transport, steady({"--device", device.name}));
    const test::TemporaryFolder folder;
    ParameterValues::Map parameters = simulator.parameters();
    parameters["profile"] = impatient_copy(device.name, folder);
    parameters["poll_interval"] = 0.05;
    parameters["response_timeout"] = 5.0;
    RunningSensor sensor(test::open_modbus_sensor(parameters));
    const bool says_more = *device.quantities != '\0';
    ASSERT_TRUE(sensor.wait_until([&](const RecordingSink& sink) {
      return sink.readings.size() >= 2 && (!says_more || !sink.station_quantities.empty());
    }));
    sensor.look([&](const RecordingSink& sink) {
      EXPECT_EQ(sink.station_quantities.empty(), !says_more);
      if (says_more) expect_station(device, sink.station_quantities.back());
      EXPECT_TRUE(sink.refusals.empty());
      const wind::Reading& reading = sink.readings.back();
      EXPECT_NEAR(reading.speed_m_s, 7.0, 1e-6);
      EXPECT_EQ(reading.direction_deg.has_value(), device.has_direction);
      EXPECT_NEAR(reading.direction_deg.value_or(135.0), 135.0, 1e-6);
      EXPECT_EQ(reading.gust_m_s.has_value(), device.has_gust);
      EXPECT_NEAR(reading.gust_m_s.value_or(7.0), 7.0, 1e-6);
    });
  }

  /// What the simulated air is like besides the wind.
  static void expect_station(const PlayedDevice& device, const wind::StationQuantities& said) {
    const auto expect = [&](char letter, const std::optional<double>& value, double true_value) {
      EXPECT_EQ(value.has_value(), std::string_view(device.quantities).find(letter) != std::string_view::npos);
      EXPECT_NEAR(value.value_or(true_value), true_value, 1e-6);
    };
    expect('t', said.air_temperature_c, -3.7);
    expect('h', said.relative_humidity_percent, 64.0);
    expect('p', said.pressure_hpa, 1009.0);
    expect('r', said.rain_total_mm, 12.6);
    EXPECT_FALSE(said.rain_rate_mm_h.has_value());
    EXPECT_FALSE(said.vertical_speed_m_s.has_value());
  }

  static std::string impatient_copy(const std::string& name, const test::TemporaryFolder& folder) {
    std::ifstream in(test::source_path("drivers/modbus/profiles/" + name + ".toml"));
    const std::string path = folder / (name + ".toml");
    std::ofstream out(path);
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with("warm_up_s")) out << line << "\n";
    }
    return path;
  }
};

TEST_P(PlayedDeviceTest, SaysTheWindOverTcp) {
  expect_agreement(Transport::kTcp);
}

TEST_P(PlayedDeviceTest, SaysTheWindOverASerialLine) {
  expect_agreement(Transport::kRtu);
}

INSTANTIATE_TEST_SUITE_P(Every, PlayedDeviceTest, testing::ValuesIn(kPlayedDevices), [](const auto& test) {
  std::string name = test.param.name;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(PlayedDevices, AreAllThatHaveAProfile) {
  std::size_t profiles = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_path("drivers/modbus/profiles"))) {
    if (entry.path().extension() != ".toml") continue;
    ++profiles;
    EXPECT_EQ(std::ranges::count(kPlayedDevices, entry.path().stem().string(), &PlayedDevice::name), 1) << entry.path();
  }
  EXPECT_EQ(profiles, kPlayedDevices.size());
}

/// Three cups on one line, each a sensor of its own.
class SharedLineTest : public testing::TestWithParam<Transport> {
 protected:
  static constexpr double kPatient_s = 10.0;
  static constexpr double kTimeoutOfTheDead_s = 1.0;

  std::unique_ptr<RunningSensor> cup(std::int64_t id, double timeout_s = kPatient_s) {
    ParameterValues::Map parameters = simulator_.parameters();
    parameters["profile"] = std::string("dfrobot-sen0483");
    parameters["speed_slave"] = id;
    parameters["poll_interval"] = 0.05;
    parameters["response_timeout"] = timeout_s;
    return std::make_unique<RunningSensor>(test::open_modbus_sensor(parameters));
  }
  /// The longest time from one reading to the next.
  static double longest_pause_s(RunningSensor& sensor) {
    return sensor.look([](const RecordingSink& sink) {
      double longest_s = 0.0;
      for (std::size_t i = 1; i < sink.readings.size(); ++i) {
        const Nanoseconds pause = sink.readings[i].time.mono - sink.readings[i - 1].time.mono;
        longest_s = std::max(longest_s, seconds(pause));
      }
      return longest_s;
    });
  }

  test::ModbusSimulatorProgram simulator_{
      GetParam(), steady({"--device", "dfrobot-sen0483@1", "--device", "dfrobot-sen0483@2", "--device",
                          "dfrobot-sen0483@3", "--fault-id", "1"})};
};

TEST_P(SharedLineTest, ServesAllWhoAreWellAndSlowsThemByOneTimeOutAtMostForOneWhoIsDead) {
  const auto one = cup(1, kTimeoutOfTheDead_s);
  const auto two = cup(2);
  const auto three = cup(3);
  for (const auto* sensor : {&one, &two, &three}) {
    ASSERT_TRUE((*sensor)->wait_until([](const RecordingSink& sink) { return sink.readings.size() >= 5; }));
  }

  // One dies: it is asked less and less often, and the others go on.
  simulator_.suffer("silence");
  ASSERT_TRUE(
      one->wait_until([](const RecordingSink& sink) { return sink.count(drivers::decode::Refusal::kTimeout) >= 1; }));
  two->forget();
  three->forget();
  ASSERT_TRUE(
      one->wait_until([](const RecordingSink& sink) { return sink.count(drivers::decode::Refusal::kTimeout) >= 3; }));
  for (const auto* sensor : {&two, &three}) {
    EXPECT_GE((*sensor)->look([](const RecordingSink& sink) { return sink.readings.size(); }), 3U);
    EXPECT_LT(longest_pause_s(**sensor), 2 * kTimeoutOfTheDead_s);  // one, the gaps, and what else the machine does
    EXPECT_EQ((*sensor)->look([](const RecordingSink& sink) { return sink.count(drivers::decode::Refusal::kTimeout); }),
              0);
  }

  // It is back by itself, and nobody was ever taken for another.
  simulator_.be_well();
  one->forget();
  EXPECT_TRUE(one->wait_until([](const RecordingSink& sink) { return sink.readings.size() >= 3; }));
  for (const auto* sensor : {&one, &two, &three}) {
    (*sensor)->look([](const RecordingSink& sink) {
      for (const wind::Reading& reading : sink.readings) EXPECT_NEAR(reading.speed_m_s, 7.0, 1e-6);
    });
  }
}

TEST_P(SharedLineTest, IsLeftByOneSensorWithoutHarmToTheOthers) {
  auto one = cup(1);
  const auto two = cup(2);
  ASSERT_TRUE(one->wait_until([](const RecordingSink& sink) { return !sink.readings.empty(); }));
  one.reset();
  two->forget();
  EXPECT_TRUE(two->wait_until([](const RecordingSink& sink) { return sink.readings.size() >= 5; }));
  EXPECT_TRUE(two->look([](const RecordingSink& sink) { return sink.refusals.empty(); }));
}

TEST_P(SharedLineTest, WaitsForNobodyAtTheEnd) {
  // All three wait for a line on which nobody answers for as long as may be set.
  simulator_.suffer("silence");
  ParameterValues::Map parameters = simulator_.parameters();
  parameters["profile"] = std::string("dfrobot-sen0483");
  parameters["speed_slave"] = std::int64_t{1};
  parameters["response_timeout"] = 10.0;
  std::vector<std::unique_ptr<RunningSensor>> sensors;
  for (int i = 0; i < 3; ++i) {
    sensors.push_back(std::make_unique<RunningSensor>(test::open_modbus_sensor(parameters)));
    if (i > 0) continue;
    ASSERT_TRUE(sensors[0]->wait_until([](const RecordingSink& sink) { return !sink.raws.empty(); })) << "it has asked";
  }
  for (const auto& sensor : sensors) {
    sensor->end();
    EXPECT_EQ(sensor->look([](const RecordingSink& sink) { return sink.count(drivers::decode::Refusal::kTimeout); }), 0)
        << "it was interrupted, and did not wait for its time-out";
  }
}

INSTANTIATE_TEST_SUITE_P(Over, SharedLineTest, testing::Values(Transport::kTcp, Transport::kRtu),
                         [](const auto& test) { return test.param == Transport::kTcp ? "Tcp" : "Rtu"; });

TEST(SeparateLines, OfCupAndVaneMakeOneSensor) {
  test::ModbusSimulatorProgram cup(Transport::kRtu, steady({"--device", "renke-rs-fsjt-n01@1"}));
  test::ModbusSimulatorProgram vane(Transport::kRtu, steady({"--device", "renke-rs-fxjt-n01@1"}));
  ParameterValues::Map parameters = cup.parameters();
  parameters["direction_device"] = vane.where();
  parameters["direction_slave"] = std::int64_t{1};
  parameters["response_timeout"] = 0.3;
  RunningSensor sensor(test::open_modbus_sensor(parameters));
  const auto has_direction = [](const RecordingSink& sink) {
    return !sink.readings.empty() && sink.readings.back().direction_deg == 135.0;
  };
  ASSERT_TRUE(sensor.wait_until(has_direction));

  // Without the vane's line the speed goes on, and says what it lacks.
  vane.suffer("unplug");
  ASSERT_TRUE(sensor.wait_until([](const RecordingSink& sink) {
    return !sink.readings.back().direction_deg && sink.last_detail().find("without direction") != std::string::npos;
  }));
  EXPECT_EQ(sensor.look([](const RecordingSink& sink) { return sink.last_state(); }), wind::LinkState::kConnected);
  vane.be_well();
  sensor.forget();
  EXPECT_TRUE(sensor.wait_until(has_direction));
}

TEST(MbpollAndSimulator, AgreeOverASerialLine) {
  if (!std::filesystem::exists("/usr/bin/mbpoll")) GTEST_SKIP() << "mbpoll is not installed";
  test::ModbusSimulatorProgram simulator(
      Transport::kRtu, steady({"--device", "renke-rs-fsjt-rs-fxjt-n01", "--device", "thies-clima-sensor-us@9"}));
  const auto exchange = [&](const std::string& slave, const std::string& type, const std::string& from,
                            const std::string& count) {
    ChildProcess mbpoll({"/usr/bin/mbpoll", "-m", "rtu", "-b", "9600", "-P", "none", "-a", slave, "-r", from, "-c",
                         count, "-t", type, "-1", "-q", "-0", simulator.where()});
    return mbpoll.rest();
  };
  EXPECT_THAT(exchange("1", "4", "0", "1"), testing::ContainsRegex("\\[0\\]:[ \t]+70"));
  EXPECT_THAT(exchange("2", "4", "0", "2"), testing::ContainsRegex("\\[1\\]:[ \t]+135"));
  EXPECT_THAT(exchange("9", "3:hex", "30203", "2"), testing::HasSubstr("0x0546"));  // 1350 in its low register
  EXPECT_THAT(exchange("1", "4", "1", "1"), testing::HasSubstr("Illegal data address"));
}

}  // namespace
}  // namespace yuragi::simulators::modbus
