// The driver as the daemon opens it, with the real libusb, on whatever machine this is.
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/bus/usb_device.hpp"
#include "drivers/sensor/driver.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"

namespace yuragi::drivers::usb {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::unique_ptr<sensor::Sensor> open_usb_sensor(const ParameterValues::Map& given) {
  return driver_named("usb").open(values_for("usb", given));
}

TEST(UsbDriver, RefusesWhatCannotWorkTogether) {
  EXPECT_THAT(
      [] {
        open_usb_sensor({{"vane_lowest", 0.9}, {"vane_highest", 0.1}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("vane_lowest")));
  EXPECT_THAT(
      [] {
        open_usb_sensor({{"reference_channel", std::int64_t{0}}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("reference_channel")));
  EXPECT_THAT(
      [] {
        open_usb_sensor({{"device", std::string("mcc1208")}, {"counter", std::int64_t{1}}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("counter: is 1; MCC USB-1208FS-Plus has counters 0 to 0")));
  EXPECT_THAT(
      [] {
        open_usb_sensor({{"device", std::string("labjack-u3")}, {"vane_channel", std::int64_t{4}}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("LabJack U3 has inputs 0 to 3")));
  EXPECT_NO_THROW(open_usb_sensor({{"counter", std::int64_t{1}}})) << "a LabJack has that";
}

TEST(UsbDriver, LooksForADeviceThatNobodyHasAndSaysSo) {
  const auto sensor = open_usb_sensor({{"serial", std::string("no such serial number")}});
  ManualClock clock;
  RecordingSink sink;
  MonoTime due{};
  for (int attempt = 0; attempt < 3; ++attempt) {
    clock.advance_to(due);
    due = sensor->poll(clock, sink);
  }
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(sink.last_detail(),
              testing::AnyOf(HasSubstr("is not plugged in: plug it in"), HasSubstr("/dev/bus/usb")));
}

TEST(UsbDriver, FindsWithoutOpeningAnything) {
  for (const sensor::FoundDevice& device : driver_named("usb").find()) {
    EXPECT_THAT(device.what, HasSubstr("at USB port"));
    EXPECT_THAT(device.settings, HasSubstr("device = "));
    EXPECT_EQ(device.trouble.empty(), device.remedy.empty());
  }
}

TEST(LibusbDevice, ThatIsNotOpenHasNoTransfers) {
  const auto device = bus::make_usb_device({{0x1209, 0x0001}});
  std::array<std::uint8_t, 4> bytes{};
  const auto timeout = std::chrono::milliseconds(10);
  EXPECT_EQ(device->control({0xC0, 0x20, 0, 0}, bytes, timeout).status, bus::UsbStatus::kGone);
  EXPECT_EQ(device->read(1, bytes, timeout).status, bus::UsbStatus::kGone);
  EXPECT_EQ(device->write(1, bytes, timeout).status, bus::UsbStatus::kGone);
  EXPECT_FALSE(device->take_arrival());
  EXPECT_FALSE(device->open({.id = {0x1209, 0x0001}, .port = "1-1", .serial = "", .node = ""}));
}

TEST(LibusbDevice, CanBeInterruptedFromAnotherThreadAtAnyTime) {
  const auto device = bus::make_usb_device({{0x1209, 0x0001}});
  std::jthread other([&device] { device->interrupt(); });
  static_cast<void>(device->plugged());
  static_cast<void>(device->take_arrival());
}

}  // namespace
}  // namespace yuragi::drivers::usb
