// What a device that says lines of text can do wrong, and what its driver makes of it: with a simulator at the other
// end of a real wire. One suite for the drivers `nmea` and `line`. The lines of `line` have no checksum: what is cut,
// joined or garbled has to be noticed otherwise.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/text/line_sensor.hpp"
#include "drivers/text/nmea_sensor.hpp"
#include "simulators/text/line_device.hpp"
#include "simulators/text/nmea_device.hpp"
#include "tests/support/text_fault_bench.hpp"

namespace yuragi::drivers::text {
namespace {

using simulators::core::FaultKind;
using testing::HasSubstr;
using Wire = TextFaultBench::Wire;

/// A device that speaks only when it is asked, in this format, and what its driver is told of that.
struct PolledDevice {
  std::string format;
  ParameterValues::Map given;
};

/// A driver, and the formats in which its device suffers each fault.
struct TextDriver {
  std::string name;
  simulators::core::PlayedMoment wind;
  double speed_tolerance_m_s = 0.0;
  double direction_tolerance_deg = 0.0;
  std::unique_ptr<simulators::text::Device> (*make_device)(const std::string& format);
  std::unique_ptr<sensor::Sensor> (*make_sensor)(const ParameterValues& values, TextBench& bench);

  bool checks_lines =
      false;  ///< a line that was cut is always refused; without that it may be taken for the beginning of the next one

  std::string usual_format;
  std::string spike_format;
  std::vector<std::string> garbage_formats;
  double garbage_on_pty_s = 0.0;  ///< on a serial line a wrong baud rate makes it, and lasts
  double garbage_s = 0.0;
  double doubt_after_garbage_s = 0.0;  ///< so long what comes after it is not believed
  std::vector<std::string> split_formats;
  std::vector<std::string> partial_formats;
  std::vector<Wire> partial_wires;
  std::vector<double> partial_rates_hz;
  std::vector<PolledDevice> polled;

  friend void PrintTo(const TextDriver& driver, std::ostream* out) { *out << driver.name; }
};

TextDriver line_driver() {
  return {
      .name = "line",
      // To the last digit: a cut number is nearly right.
      .wind = {.speed_m_s = 7.25, .direction_deg = 123.5},
      .make_device = [](const std::string& format) { return simulators::text::make_line_device(format); },
      .make_sensor = [](const ParameterValues& values, TextBench& bench) -> std::unique_ptr<sensor::Sensor> {
        const LineSensorSettings settings = line_sensor_settings_of(values);
        return std::make_unique<LineSensor>(settings, bench.port(settings.text.address));
      },
      .usual_format = "csv",
      .spike_format = "key-value",
      .garbage_formats = {"csv", "key-value"},
      .garbage_on_pty_s = 60.0,
      .garbage_s = 6.0,
      .doubt_after_garbage_s = 1.0,
      .split_formats = {"csv", "key-value"},
      .partial_formats = {"csv", "key-value"},
      .partial_wires = {Wire::kPty, Wire::kTcp},
      .partial_rates_hz = {1.0, 4.0, 20.0},
      .polled = {{"csv", {{"request", std::string("?\n")}, {"poll_interval", 0.25}}}},
  };
}

TextDriver nmea_driver() {
  return {
      .name = "nmea",
      .wind = {.speed_m_s = 7.0, .direction_deg = 123.0},
      .speed_tolerance_m_s = 0.06,
      .direction_tolerance_deg = 0.6,
      .make_device = [](const std::string& format) { return simulators::text::make_nmea_device({format}); },
      .make_sensor = [](const ParameterValues& values, TextBench& bench) -> std::unique_ptr<sensor::Sensor> {
        const NmeaSensorSettings settings = nmea_sensor_settings_of(values);
        return std::make_unique<NmeaSensor>(settings, bench.port(settings.text.address));
      },
      .checks_lines = true,
      .usual_format = "mwv",
      .spike_format = "gill",
      .garbage_formats = {"mwv"},
      .garbage_on_pty_s = 10.0,
      .garbage_s = 10.0,
      .split_formats = {"mwv", "gill", "ft", "wxt"},
      .partial_formats = {"mwv", "gill", "wxt"},
      .partial_wires = {Wire::kPty, Wire::kTcp, Wire::kUdp},
      .partial_rates_hz = {4.0},
      .polled = {{"umb", {{"format", std::string("umb")}, {"poll_interval", 0.25}}},
                 {"ft", {{"format", std::string("ft")}, {"poll_interval", 0.25}}},
                 {"wxt", {{"format", std::string("wxt")}, {"poll_interval", 0.25}}}},
  };
}

/// The bench with one of these drivers on it.
class TextDriverBench : public TextFaultBench {
 protected:
  explicit TextDriverBench(TextDriver driver) : TextFaultBench(driver.name, driver.wind), driver_(std::move(driver)) {}

  void put(Wire wire, const std::string& format, double rate_hz, ParameterValues::Map given = {}) {
    connect(wire, driver_.make_device(format), rate_hz, std::move(given), driver_.make_sensor);
  }
  void expect_only_the_wind() override {
    for (const wind::Reading& reading : bench_.sink.readings) {
      EXPECT_LE(std::abs(reading.speed_m_s - driver_.wind.speed_m_s), driver_.speed_tolerance_m_s);
      ASSERT_TRUE(reading.direction_deg.has_value());
      EXPECT_LE(std::abs(*reading.direction_deg - driver_.wind.direction_deg), driver_.direction_tolerance_deg);
    }
  }

  TextDriver driver_;
};

/// The faults that both suffer. Its instantiations are named for the drivers: the table of faults reads them.
class Fault : public TextDriverBench, public testing::WithParamInterface<TextDriver> {
 protected:
  Fault() : TextDriverBench(GetParam()) {}
};

std::string fault_test_name(const testing::TestParamInfo<TextDriver>& test) {
  return test.param.name;
}
INSTANTIATE_TEST_SUITE_P(Line, Fault, testing::Values(line_driver()), fault_test_name);
INSTANTIATE_TEST_SUITE_P(Nmea, Fault, testing::Values(nmea_driver()), fault_test_name);

TEST_P(Fault, Silence) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, driver_.usual_format, 4.0);
    ASSERT_TRUE(is_live());
    bench_.run(1.0);
    bench_.run(3.5, FaultKind::kSilence);
    EXPECT_LE(bench_.sink.readings.size(), 1U) << "one may have been on its way";
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("is open, but silent"));

    // At some time the port itself is doubted, and opened again.
    bench_.run(5.0, FaultKind::kSilence);
    EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 1) << bench_.sink.last_detail();
    EXPECT_TRUE(bench_.sink.readings.empty());
    expect_return();
  }
}

TEST_P(Fault, Freeze) {
  put(Wire::kPty, driver_.usual_format, 4.0);
  ASSERT_TRUE(is_live());
  bench_.run(5.0, FaultKind::kFreeze);
  EXPECT_GE(bench_.sink.readings.size(), 18U) << "the driver publishes what the device says; the hub judges it";
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
  expect_return();
}

TEST_P(Fault, Spike) {
  put(Wire::kPty, driver_.spike_format, 4.0);
  ASSERT_TRUE(is_live());
  bench_.run(5.0);
  ASSERT_FALSE(bench_.sink.believed.empty());
  bench_.run(2.0, FaultKind::kSpike);
  EXPECT_NEAR(bench_.sink.readings.back().speed_m_s, 55.0, 0.01);
  EXPECT_EQ(bench_.sink.judge.fault(), wind::judging::ReadingFault::kSpike);
  for (const wind::Reading& believed : bench_.sink.believed) {
    EXPECT_LE(std::abs(believed.speed_m_s - driver_.wind.speed_m_s), driver_.speed_tolerance_m_s)
        << "the hub keeps it from the wind";
  }
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
  expect_return();
}

TEST_P(Fault, Garbage) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    for (const std::string& format : driver_.garbage_formats) {
      put(wire, format, 10.0);
      ASSERT_TRUE(is_live());
      bench_.run(wire == Wire::kPty ? driver_.garbage_on_pty_s : driver_.garbage_s, FaultKind::kGarbage);
      EXPECT_TRUE(bench_.sink.readings.empty()) << "among random bytes there are numbers, but no reading";
      EXPECT_FALSE(bench_.sink.refusals.empty());
      EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
      EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("but no lines: check"));
      if (wire == Wire::kPty) {
        EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("baud"));
      }
      // The first line after it may have some of it in front.
      ASSERT_TRUE(is_live());
      bench_.run(driver_.doubt_after_garbage_s);
      expect_return();
    }
  }
}

TEST_P(Fault, Split) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    for (const std::string& format : driver_.split_formats) {
      put(wire, format, 4.0);
      ASSERT_TRUE(is_live());
      bench_.run(5.0, FaultKind::kSplit);
      EXPECT_GE(bench_.sink.readings.size(), 18U);
      EXPECT_TRUE(bench_.sink.refusals.empty());
      expect_only_the_wind();
      EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
      expect_return();
    }
  }
}

TEST_P(Fault, Partial) {
  for (const Wire wire : driver_.partial_wires) {
    for (const std::string& format : driver_.partial_formats) {
      for (const double rate_hz : driver_.partial_rates_hz) {
        put(wire, format, rate_hz);
        ASSERT_TRUE(is_live());
        bench_.run(3.0 / rate_hz);
        bench_.run(12.0, FaultKind::kPartial);
        EXPECT_TRUE(bench_.sink.readings.empty());
        EXPECT_TRUE(!driver_.checks_lines || !bench_.sink.refusals.empty());
        EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting) << bench_.sink.last_detail();

        // The first line end after it belongs to what was cut.
        bench_.run(10.0);
        EXPECT_GE(static_cast<double>(bench_.sink.readings.size()), 6.0 * rate_hz);
        expect_only_the_wind();
        EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
        if (rate_hz == 4.0) expect_return();
      }
    }
  }
}

TEST_P(Fault, Late) {
  for (const PolledDevice& polled : driver_.polled) {
    put(Wire::kPty, polled.format, 0.0, polled.given);
    ASSERT_TRUE(is_live());
    bench_.run(15.0, FaultKind::kLate);
    EXPECT_TRUE(bench_.sink.readings.empty()) << "an answer to an earlier question was taken for the one to this";
    EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 2);
    EXPECT_GE(bench_.sink.count(decode::Refusal::kNotMine), 2);
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("increase response_timeout"));
    ASSERT_TRUE(is_live());
    expect_return();
  }
}

TEST_P(Fault, Disconnect) {
  put(Wire::kTcp, driver_.usual_format, 4.0);
  ASSERT_TRUE(is_live());
  expect_silence(FaultKind::kDisconnect, 5.0);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("cannot connect to 127.0.0.1:"));
  expect_return();
}

TEST_P(Fault, Unplug) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, driver_.usual_format, 4.0);
    ASSERT_TRUE(is_live());
    expect_silence(FaultKind::kUnplug, 6.0);
    if (wire == Wire::kPty) {
      EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("check that it is plugged in"));
    }
    expect_return();
  }
}

/// What only a device that names and checks its lines can suffer.
class NmeaFault : public TextDriverBench {
 protected:
  NmeaFault() : TextDriverBench(nmea_driver()) {}
};

TEST_F(NmeaFault, BadChecksum) {
  for (const std::string format : {"mwv", "mwd", "xdr", "gill", "gill-uv", "ft", "wxt"}) {
    put(Wire::kPty, format, 4.0);
    ASSERT_TRUE(is_live());
    bench_.run(5.0, FaultKind::kBadChecksum);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_GE(bench_.sink.count(decode::Refusal::kBadChecksum), 18);
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("wrong checksums: check its cable and baud"));
    expect_return();
  }
}

TEST_F(NmeaFault, WrongId) {
  const std::vector<std::pair<std::string, std::string>> talkers = {
      {"mwv", "WI"}, {"gill", "Q"}, {"ft", "WI"}, {"wxt", "0"}};
  for (const auto& [format, talker] : talkers) {
    put(Wire::kPty, format, 4.0, {{"talker", talker}});
    ASSERT_TRUE(is_live());
    bench_.run(5.0, FaultKind::kWrongId);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_GE(bench_.sink.count(decode::Refusal::kNotMine), 18);
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("talker"));
    expect_return();
  }
}

}  // namespace
}  // namespace yuragi::drivers::text
