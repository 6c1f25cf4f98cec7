// The driver's work with a simulated device, by a clock that the test moves.
#include "drivers/usb/usb_sensor.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/usb_bench.hpp"

namespace yuragi::drivers::usb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

class UsbSensorTest : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Every, UsbSensorTest, testing::ValuesIn(simulators::usb::daq_names()),
                         [](const auto& name) { return name.param == "mcc1208" ? "Mcc1208" : "LabjackU3"; });

TEST_P(UsbSensorTest, ReadsTheSpeedAndTheDirectionOfTheWind) {
  UsbBench bench(GetParam());
  for (const double speed_m_s : {5.0, 0.3, 25.0}) {
    for (const double direction_deg : {10.0, 180.0, 340.0}) {
      bench.bus.wind = {speed_m_s, direction_deg};
      bench.poll_for(2.0);  // the last window of the wind before
      bench.sink = {};
      bench.poll_for(20.0);
      ASSERT_GE(bench.sink.readings.size(), 18U) << speed_m_s;
      double sum_m_s = 0.0;
      for (const wind::Reading& reading : bench.sink.readings) {
        sum_m_s += reading.speed_m_s;
        ASSERT_TRUE(reading.direction_deg.has_value());
        EXPECT_NEAR(*reading.direction_deg, direction_deg, 0.5);
        EXPECT_FALSE(reading.gust_m_s.has_value());
      }
      EXPECT_NEAR(sum_m_s / static_cast<double>(bench.sink.readings.size()), speed_m_s, 0.02 * speed_m_s + 0.02);
      EXPECT_THAT(bench.sink.refusals, IsEmpty());
    }
  }
}

TEST_P(UsbSensorTest, IsCalmWithoutPulsesAfterTheLongestWindow) {
  UsbBench bench(GetParam());
  bench.bus.wind = {0.0, 90.0};
  bench.settings.cup.offset_m_s = 0.4;
  bench.poll_for(5.0);
  ASSERT_GE(bench.sink.readings.size(), 4U);
  for (const wind::Reading& reading : bench.sink.readings) EXPECT_EQ(reading.speed_m_s, 0.0);
}

TEST_P(UsbSensorTest, HasNoDirectionWhereTheVaneHasNoTrack) {
  UsbBench bench(GetParam());
  bench.bus.wind = {5.0, 358.0};
  bench.poll_for(2.0);
  ASSERT_FALSE(bench.sink.readings.empty());
  for (const wind::Reading& reading : bench.sink.readings) EXPECT_FALSE(reading.direction_deg.has_value());
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
}

TEST_P(UsbSensorTest, HasNoDirectionWithoutAVane) {
  UsbBench bench(GetParam());
  bench.settings.wiring.vane_channel.reset();
  bench.poll_for(2.0);
  ASSERT_FALSE(bench.sink.readings.empty());
  EXPECT_FALSE(bench.sink.readings.back().direction_deg.has_value());
}

TEST_P(UsbSensorTest, MeasuresTheReferenceWhereItIsConnected) {
  UsbBench bench(GetParam());
  bench.settings.reference_v = 4.0;  // wrong, and of no account
  bench.settings.wiring.reference_channel = 1;
  bench.poll_for(2.0);
  ASSERT_FALSE(bench.sink.readings.empty());
  EXPECT_NEAR(*bench.sink.readings.back().direction_deg, 90.0, 0.5);
}

TEST_P(UsbSensorTest, SamplesAtItsRate) {
  UsbBench bench(GetParam());
  bench.settings.period = std::chrono::milliseconds(20);
  bench.bus.wind = {40.0, 90.0};
  bench.poll_for(2.0);
  bench.sink = {};
  bench.poll_for(2.0);
  EXPECT_NEAR(static_cast<double>(bench.sink.readings.size()), 33.0, 2.0) << "windows of at least 50 ms, 20 ms apart";
}

TEST_P(UsbSensorTest, MakesNoGustOfAThreadThatIsHeldUp) {
  UsbBench bench(GetParam());
  bench.poll_for(3.0);
  bench.sink.readings.clear();
  for (int round = 0; round < 20; ++round) {
    bench.bus.transfer_time = std::chrono::milliseconds(40);
    bench.poll();
    bench.bus.transfer_time = {};
    bench.poll_for(0.7);
  }
  EXPECT_GE(bench.sink.readings.size(), 60U);
  for (const wind::Reading& reading : bench.sink.readings) EXPECT_NEAR(reading.speed_m_s, 5.0, 1.1);
}

TEST_P(UsbSensorTest, ReadsASlowBusLessOften) {
  UsbBench bench(GetParam());
  bench.bus.transfer_time = std::chrono::milliseconds(30);
  bench.poll_for(3.0);
  bench.sink.readings.clear();
  bench.poll_for(20.0);
  EXPECT_GE(bench.sink.readings.size(), 20U);
  for (const wind::Reading& reading : bench.sink.readings) EXPECT_NEAR(reading.speed_m_s, 5.0, 1.1);
}

TEST_P(UsbSensorTest, ShowsEveryMessageBothWays) {
  UsbBench bench(GetParam());
  bench.poll_for(1.0);
  const auto sent = std::ranges::count(bench.sink.raws, sensor::RawDirection::kSent, &RecordingSink::Raw::direction);
  EXPECT_GE(sent, 10);
  EXPECT_EQ(2 * sent, std::ssize(bench.sink.raws)) << "each question was answered";
}

TEST_P(UsbSensorTest, SaysWhichDeviceItReads) {
  UsbBench bench(GetParam());
  bench.poll_for(1.0);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("at USB port 1-2"));
}

TEST_P(UsbSensorTest, IsThereAsSoonAsItIsPluggedInAgain) {
  UsbBench bench(GetParam());
  bench.bus.fault = simulators::core::FaultKind::kUnplug;
  bench.poll_for(120.0);  // by now it looks for it every ten seconds
  bench.bus.fault.reset();
  bench.bus.has_arrived = true;
  const MonoTime arrived = bench.clock.now().mono;
  bench.due = arrived;  // whoever polls looks in at least once a second
  EXPECT_TRUE(bench.poll_for_reading(2.0));
  EXPECT_LE(seconds(bench.clock.now().mono - arrived), 1.5);
}

TEST_P(UsbSensorTest, EndsItsWaitsWhenItIsInterrupted) {
  UsbBench bench(GetParam());
  bench.poll_for(1.0);
  bench.sensor->interrupt();
  EXPECT_TRUE(bench.bus.is_interrupted);
}

TEST(UsbSensor, ReadsTheOneWithTheSerialNumberThatTheBusShows) {
  UsbBench bench;
  bench.plug("mcc1208", "1-1", "AAAA");
  bench.plug("mcc1208", "1-2", "BBBB");
  bench.settings.serial = "BBBB";
  bench.poll_for(1.0);
  EXPECT_THAT(bench.sink.last_detail(), AllOf(HasSubstr("port 1-2"), HasSubstr("serial number BBBB")));
}

TEST(UsbSensor, ReadsTheOneAtItsPort) {
  UsbBench bench;
  bench.plug("labjack-u3", "1-1");
  bench.plug("mcc1208", "1-2.4");
  bench.settings.port = "1-2.4";
  bench.poll_for(1.0);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("MCC USB-1208FS-Plus at USB port 1-2.4"));
}

TEST(UsbSensor, FindsTheLabjackThatTellsTheRightSerialNumberWhenItIsAsked) {
  UsbBench bench;
  bench.plug("mcc1208", "1-1", "AAAA");
  bench.plug("labjack-u3", "1-2");
  bench.settings.serial = "320012345";
  EXPECT_TRUE(bench.poll_for_reading(5.0));
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("LabJack U3 at USB port 1-2, serial number 320012345"));
}

TEST(UsbSensor, SaysWhatIsMissing) {
  UsbBench bench;
  bench.settings.serial = "BBBB";
  bench.poll_for(1.0);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(bench.sink.last_detail(),
              AllOf(HasSubstr("MCC USB-1208FS-Plus (09db:00e8) or LabJack U3 (0cd5:0003) with serial number BBBB"),
                    HasSubstr("is not plugged in")));
}

TEST(UsbSensor, SaysWhichInputADeviceDoesNotHave) {
  UsbBench bench("labjack-u3");
  bench.settings.wiring.vane_channel = 5;
  bench.poll_for(1.0);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("vane_channel: is 5; LabJack U3 has inputs 0 to 3"));
}

TEST(UsbSensor, BeginsANewWindowWhenTheCounterWasReset) {
  UsbBench bench("mcc1208");
  bench.poll_for(3.0);
  bench.sink = {};
  static_cast<void>(bench.bus.sockets[0].device->control({0x40, 0x20, 0, 0, 0}, {}));
  bench.poll_for(3.0);
  EXPECT_EQ(bench.sink.count(decode::Refusal::kImplausible), 1);
  ASSERT_GE(bench.sink.readings.size(), 25U);
  for (const wind::Reading& reading : bench.sink.readings) EXPECT_NEAR(reading.speed_m_s, 5.0, 1.1);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
}

TEST(UsbSensor, SetsALabjackUpAgainWhoseCounterAnotherProgramHasTurnedOff) {
  UsbBench bench("labjack-u3");
  bench.poll_for(3.0);
  static_cast<void>(bench.bus.sockets[0].device->out(
      1, simulators::usb::Bytes{0x57, 0xF8, 0x03, 0x0B, 0x50, 0x00, 0x01, 0x00, 0x40, 0x00, 0x0F, 0x00}));
  bench.poll_for(0.3);
  EXPECT_THAT(bench.sink.refusals, testing::Contains(decode::Refusal::kException));
  EXPECT_TRUE(bench.poll_for_reading(2.0));
  EXPECT_EQ(bench.bus.opened, 2);
}

TEST(UsbSensor, TakesTheSecondCounterOfALabjack) {
  UsbBench bench("labjack-u3");
  bench.settings.wiring.counter = 1;
  bench.poll_for(3.0);
  ASSERT_FALSE(bench.sink.readings.empty());
  EXPECT_NEAR(bench.sink.readings.back().speed_m_s, 5.0, 1.1);
}

TEST(MeanDirection, CrossesNorthWithoutHarm) {
  MeanDirection mean;
  EXPECT_FALSE(mean.mean_deg().has_value());
  mean.add(350.0);
  mean.add(20.0);
  EXPECT_NEAR(*mean.mean_deg(), 5.0, 1e-9);
  mean.clear();
  mean.add(10.0);
  mean.add(190.0);
  EXPECT_FALSE(mean.mean_deg().has_value()) << "they cancel";
  for (int step = 0; step < 7200; ++step) {
    mean.clear();
    mean.add(step * 0.05);
    ASSERT_TRUE(mean.mean_deg().has_value());
    EXPECT_GE(*mean.mean_deg(), 0.0);
    EXPECT_LT(*mean.mean_deg(), 360.0);
    EXPECT_NEAR(std::remainder(*mean.mean_deg() - step * 0.05, 360.0), 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace yuragi::drivers::usb
