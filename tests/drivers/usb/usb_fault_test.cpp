// What each fault of a counter and ADC device comes to: the state within its time, nothing false, and the reading
// again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/usb_bench.hpp"

namespace yuragi::drivers::usb {
namespace {

using simulators::core::FaultKind;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;

/// Longer than the longest wait between two attempts to open.
constexpr double kBackWithin_s = 11.0;
/// Three rounds of questions that wait for the time-out, and one more.
constexpr double kSeenWithin_s = 2.1;

class UsbFault : public testing::Test {
 protected:
  static void expect_true_readings(const UsbBench& bench) {
    for (const wind::Reading& reading : bench.sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, 5.0, 1.1);
      ASSERT_TRUE(reading.direction_deg.has_value());
      EXPECT_NEAR(*reading.direction_deg, 90.0, 0.5);
    }
  }

  /// The device fails so for half a minute. It is seen in time and counted as `why`, nothing false is published, and
  /// the reading returns.
  static void expect_silence_until_it_ends(const std::string& device, FaultKind kind,
                                           std::optional<decode::Refusal> why) {
    SCOPED_TRACE(device);
    UsbBench bench(device);
    bench.poll_for(5.0);
    ASSERT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);

    bench.sink.refusals.clear();
    bench.bus.fault = kind;
    bench.poll_for(kSeenWithin_s);
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
    if (why) {
      EXPECT_THAT(bench.sink.refusals, Contains(*why));
    }
    const auto before = bench.sink.readings.size();
    bench.poll_for(30.0);
    EXPECT_EQ(bench.sink.readings.size(), before);
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);

    bench.bus.fault.reset();
    EXPECT_TRUE(bench.poll_for_reading(kBackWithin_s));
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
    bench.poll_for(5.0);
    expect_true_readings(bench);
  }

  /// A device may be wrong for a moment only.
  static void expect_no_harm_of_one_second(const std::string& device, FaultKind kind) {
    SCOPED_TRACE(device);
    UsbBench bench(device);
    bench.poll_for(5.0);
    bench.bus.fault = kind;
    bench.poll_for(1.0);
    bench.bus.fault.reset();
    bench.poll_for(12.0);
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
    EXPECT_GE(seconds(bench.sink.readings.back().time.mono - bench.bus.start), 17.0);
    expect_true_readings(bench);
  }
};

TEST_F(UsbFault, Silence) {
  for (const std::string& device : simulators::usb::daq_names()) {
    expect_silence_until_it_ends(device, FaultKind::kSilence, decode::Refusal::kTimeout);
    expect_no_harm_of_one_second(device, FaultKind::kSilence);
  }
}

TEST_F(UsbFault, Garbage) {
  for (const std::string& device : simulators::usb::daq_names()) {
    expect_silence_until_it_ends(device, FaultKind::kGarbage, std::nullopt);
    expect_no_harm_of_one_second(device, FaultKind::kGarbage);
  }
}

TEST_F(UsbFault, Partial) {
  for (const std::string& device : simulators::usb::daq_names()) {
    expect_silence_until_it_ends(device, FaultKind::kPartial, decode::Refusal::kTooShort);
    expect_no_harm_of_one_second(device, FaultKind::kPartial);
  }
}

TEST_F(UsbFault, BadChecksum) {
  expect_silence_until_it_ends("labjack-u3", FaultKind::kBadChecksum, decode::Refusal::kBadChecksum);
  expect_no_harm_of_one_second("labjack-u3", FaultKind::kBadChecksum);
}

TEST_F(UsbFault, WrongTransaction) {
  expect_silence_until_it_ends("labjack-u3", FaultKind::kWrongTransaction, decode::Refusal::kNotMine);
  expect_no_harm_of_one_second("labjack-u3", FaultKind::kWrongTransaction);
}

TEST_F(UsbFault, Late) {
  expect_silence_until_it_ends("labjack-u3", FaultKind::kLate, decode::Refusal::kNotMine);
  expect_no_harm_of_one_second("labjack-u3", FaultKind::kLate);
}

TEST_F(UsbFault, Exception) {
  for (const std::string& device : simulators::usb::daq_names()) {
    expect_silence_until_it_ends(device, FaultKind::kException, decode::Refusal::kException);
    expect_no_harm_of_one_second(device, FaultKind::kException);
  }
}

TEST_F(UsbFault, Unplug) {
  for (const std::string& device : simulators::usb::daq_names()) {
    expect_silence_until_it_ends(device, FaultKind::kUnplug, std::nullopt);
    expect_no_harm_of_one_second(device, FaultKind::kUnplug);
  }
}

TEST_F(UsbFault, WrongId) {
  // Somebody has swapped two devices: the one that is there is not the one that is wanted.
  UsbBench bench("labjack-u3");
  bench.settings.serial = "111";
  bench.poll_for(30.0);
  EXPECT_TRUE(bench.sink.readings.empty());
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("has serial number 320012345, not 111"));

  bench.plug("mcc1208", "1-3", "111");
  EXPECT_TRUE(bench.poll_for_reading(2.0 * kBackWithin_s)) << "both had their turn";
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("1-3, serial number 111"));
}

TEST_F(UsbFault, Freeze) {
  // The cup jams: to the counter that is a calm, and the hub has to judge it. What it missed makes no gust afterwards.
  for (const std::string& device : simulators::usb::daq_names()) {
    SCOPED_TRACE(device);
    UsbBench bench(device);
    bench.poll_for(5.0);
    bench.bus.fault = FaultKind::kFreeze;
    bench.poll_for(2.0);
    bench.sink = {};
    bench.poll_for(10.0);
    EXPECT_THAT(bench.sink.readings, Each(testing::Field(&wind::Reading::speed_m_s, 0.0)));
    EXPECT_GE(bench.sink.readings.size(), 9U);
    bench.bus.fault.reset();
    bench.poll_for(2.0);
    bench.sink.readings.clear();
    bench.poll_for(3.0);
    EXPECT_GE(bench.sink.readings.size(), 25U);
    expect_true_readings(bench);
    EXPECT_TRUE(bench.sink.links.empty()) << "it stays connected throughout";
  }
}

TEST_F(UsbFault, Spike) {
  // 55 m/s is a wind: the driver says what the device says, and the hub has to judge it.
  for (const std::string& device : simulators::usb::daq_names()) {
    SCOPED_TRACE(device);
    UsbBench bench(device);
    bench.poll_for(5.0);
    EXPECT_GT(bench.sink.believed.size(), 40U);
    bench.bus.fault = FaultKind::kSpike;
    bench.poll_for(1.0);
    EXPECT_NEAR(bench.sink.readings.back().speed_m_s, 55.0, 2.0);
    EXPECT_THAT(bench.sink.believed, Each(testing::Field(&wind::Reading::speed_m_s, testing::Lt(10.0))))
        << "the hub keeps it from the wind";
    EXPECT_TRUE(bench.sink.refusals.empty());
    bench.bus.fault.reset();
    bench.poll_for(1.0);
    bench.sink.readings.clear();
    bench.poll_for(3.0);
    EXPECT_GE(bench.sink.readings.size(), 25U);
    expect_true_readings(bench);
  }
}

}  // namespace
}  // namespace yuragi::drivers::usb
