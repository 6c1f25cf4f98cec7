// A simulated device in a testbed of umockdev's, used by the real hidapi and the real libusb.
#include <array>
#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hidapi/hidapi.h>
#include <libusb-1.0/libusb.h>

#include "simulators/usb/umockdev_simulator.hpp"
#include "tests/simulators/usb/steady_wind.hpp"
#include "tests/support/simulator_thread.hpp"

namespace yuragi::simulators::usb {
namespace {

using namespace std::chrono_literals;

constexpr int kPatience_ms = 60'000;  // only a hang takes so long

class UmockdevTest : public testing::Test {
 protected:
  SimulatorThread simulator_{std::make_unique<UmockdevSimulator>(echo_ports(2))};
};

// ---- hidapi, over /dev/hidraw ----

struct CloseHid {
  void operator()(hid_device* device) const { hid_close(device); }
};
using Hid = std::unique_ptr<hid_device, CloseHid>;

class UmockdevHidTest : public UmockdevTest {
 protected:
  UmockdevHidTest() { hid_init(); }
  ~UmockdevHidTest() override { hid_exit(); }

  static Hid open() { return Hid(hid_open(EchoDevice::kVendor, EchoDevice::kProduct, nullptr)); }
  static int devices() {
    hid_device_info* const first = hid_enumerate(EchoDevice::kVendor, EchoDevice::kProduct);
    int count = 0;
    for (const hid_device_info* info = first; info != nullptr; info = info->next) ++count;
    hid_free_enumeration(first);
    return count;
  }
};

TEST_F(UmockdevHidTest, IsFoundWithItsNames) {
  ASSERT_EQ(devices(), 2);
  hid_device_info* const first = hid_enumerate(EchoDevice::kVendor, EchoDevice::kProduct);
  EXPECT_STREQ(first->path, "/dev/hidraw0");
  EXPECT_STREQ(first->product_string, L"Echo");
  EXPECT_STREQ(first->manufacturer_string, L"Yuragi");
  EXPECT_STREQ(first->serial_number, L"E0001");
  EXPECT_EQ(first->interface_number, 0);
  hid_free_enumeration(first);
}

TEST_F(UmockdevHidTest, GivesEachReportOnceAndWaitsForTheNext) {
  const Hid device = open();
  ASSERT_TRUE(device);
  std::uint32_t last = 0;
  for (int i = 0; i < 20; ++i) {
    std::array<std::uint8_t, 64> report{};
    ASSERT_EQ(hid_read_timeout(device.get(), report.data(), report.size(), kPatience_ms), 8) << i;
    ASSERT_EQ(report[0], 'W');
    const std::uint32_t number = report[1] | (std::uint32_t{report[2]} << 8U);
    ASSERT_TRUE(last == 0 || number == last + 1) << number << " after " << last;
    last = number;
  }
}

TEST_F(UmockdevHidTest, SetsAndGetsReports) {
  const Hid device = open();
  ASSERT_TRUE(device);
  std::array<std::uint8_t, 9> report = {0, 8, 7, 6, 5, 4, 3, 2, 1};
  EXPECT_EQ(hid_send_feature_report(device.get(), report.data(), report.size()), 9);
  std::array<std::uint8_t, 9> got{};
  EXPECT_EQ(hid_get_feature_report(device.get(), got.data(), got.size()), 9);
  EXPECT_EQ(got, report);

  // There is no interrupt OUT end point: what is written goes by SET_REPORT too.
  report[1] = 0x55;
  EXPECT_EQ(hid_write(device.get(), report.data(), report.size()), 9);
  EXPECT_EQ(hid_get_input_report(device.get(), got.data(), got.size()), 9);
  EXPECT_EQ(got, report);
}

TEST_F(UmockdevHidTest, ASilentDeviceLetsItsReaderWait) {
  const Hid device = open();
  ASSERT_TRUE(device);
  std::array<std::uint8_t, 64> report{};
  ASSERT_EQ(hid_read_timeout(device.get(), report.data(), report.size(), kPatience_ms), 8);
  simulator_.set_fault(core::FaultKind::kSilence);
  // What it said before may still be to read.
  while (hid_read_timeout(device.get(), report.data(), report.size(), 0) > 0) {
  }
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(hid_read_timeout(device.get(), report.data(), report.size(), 100), 0);
  EXPECT_GE(std::chrono::steady_clock::now() - begun, 90ms);
  simulator_.set_fault(std::nullopt);
  EXPECT_EQ(hid_read_timeout(device.get(), report.data(), report.size(), kPatience_ms), 8);
}

TEST_F(UmockdevHidTest, VanishesAndReturns) {
  for (int round = 0; round < 3; ++round) {
    Hid device = open();
    ASSERT_TRUE(device) << round;
    std::array<std::uint8_t, 64> report{};
    ASSERT_EQ(hid_read_timeout(device.get(), report.data(), report.size(), kPatience_ms), 8);
    simulator_.set_fault(core::FaultKind::kUnplug);
    while (hid_read_timeout(device.get(), report.data(), report.size(), 0) > 0) {
    }
    EXPECT_EQ(hid_read_timeout(device.get(), report.data(), report.size(), kPatience_ms), -1);
    EXPECT_EQ(hid_write(device.get(), report.data(), 9), -1);
    EXPECT_EQ(devices(), 0);
    EXPECT_FALSE(open());
    device.reset();
    simulator_.set_fault(std::nullopt);
    EXPECT_EQ(devices(), 2);
  }
}

// ---- libusb, over /dev/bus/usb ----

class UmockdevUsbTest : public UmockdevTest {
 protected:
  UmockdevUsbTest() { EXPECT_EQ(libusb_init(&context_), 0); }
  ~UmockdevUsbTest() override {
    if (handle_ != nullptr) libusb_close(handle_);
    libusb_exit(context_);
  }

  bool open() {
    handle_ = libusb_open_device_with_vid_pid(context_, EchoDevice::kVendor, EchoDevice::kProduct);
    return handle_ != nullptr && libusb_claim_interface(handle_, 1) == 0;
  }
  int bulk_out(std::vector<std::uint8_t> bytes) {
    int sent = 0;
    const int error = libusb_bulk_transfer(handle_, 0x02, bytes.data(), static_cast<int>(bytes.size()), &sent, 5000);
    return error == 0 ? sent : error;
  }

  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
};

TEST_F(UmockdevUsbTest, AnswersControlTransfers) {
  ASSERT_TRUE(open());
  std::array<std::uint8_t, 16> answer{};
  EXPECT_EQ(libusb_control_transfer(handle_, 0xC0, 0x42, 0, 0, answer.data(), answer.size(), 5000), 6);
  EXPECT_EQ(answer[0], 'V');
  EXPECT_EQ(libusb_control_transfer(handle_, 0xC0, 0x43, 0, 0, answer.data(), answer.size(), 5000), LIBUSB_ERROR_PIPE);
  std::array<unsigned char, 64> text{};
  EXPECT_EQ(libusb_get_string_descriptor_ascii(handle_, 3, text.data(), text.size()), 5);
  EXPECT_STREQ(reinterpret_cast<const char*>(text.data()), "E0001");
}

TEST_F(UmockdevUsbTest, CarriesBulkBothWays) {
  ASSERT_TRUE(open());
  EXPECT_EQ(bulk_out({0x0F, 0x33}), 2);
  std::array<std::uint8_t, 64> echo{};
  int size = 0;
  EXPECT_EQ(libusb_bulk_transfer(handle_, 0x82, echo.data(), echo.size(), &size, 5000), 0);
  EXPECT_EQ(size, 2);
  EXPECT_EQ(echo[0], 0xF0);
  EXPECT_EQ(echo[1], 0xCC);
  EXPECT_EQ(bulk_out({0xFF}), LIBUSB_ERROR_PIPE);
}

TEST_F(UmockdevUsbTest, ATransferThatIsNotAnsweredTimesOutAndCostsNoTime) {
  ASSERT_TRUE(open());
  std::array<std::uint8_t, 64> echo{};
  int size = 0;
  const auto work_s = [] {
    timespec used{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
  };
  const double before_s = work_s();
  EXPECT_EQ(libusb_bulk_transfer(handle_, 0x82, echo.data(), echo.size(), &size, 300), LIBUSB_ERROR_TIMEOUT);
  EXPECT_LT(work_s() - before_s, 0.1) << "it waited, and did not spin";
  EXPECT_EQ(bulk_out({1}), 1) << "and the next one is answered";
}

TEST_F(UmockdevUsbTest, VanishesAndReturnsAndTheListenersAreTold) {
  struct Seen {
    int arrived = 0;
    int left = 0;
  } seen;
  const auto count = [](libusb_context*, libusb_device*, libusb_hotplug_event event, void* user) {
    auto& counts = *static_cast<Seen*>(user);
    ++(event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED ? counts.arrived : counts.left);
    return 0;
  };
  ASSERT_EQ(
      libusb_hotplug_register_callback(context_, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
                                       LIBUSB_HOTPLUG_ENUMERATE, EchoDevice::kVendor, LIBUSB_HOTPLUG_MATCH_ANY,
                                       LIBUSB_HOTPLUG_MATCH_ANY, count, &seen, nullptr),
      0);
  EXPECT_EQ(seen.arrived, 2);
  // libusb's own thread brings the news; its events are waited for until what is counted has come, or it hangs.
  const auto wait_for_count = [&](const int& counted, int wanted) {
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (counted < wanted && std::chrono::steady_clock::now() < deadline) {
      timeval turn{1, 0};
      libusb_handle_events_timeout_completed(context_, &turn, nullptr);
    }
    EXPECT_EQ(counted, wanted);
  };
  ASSERT_TRUE(open());
  for (int round = 1; round <= 2; ++round) {
    simulator_.set_fault(core::FaultKind::kUnplug);
    EXPECT_EQ(bulk_out({1}), LIBUSB_ERROR_NO_DEVICE);
    wait_for_count(seen.left, 2 * round);
    libusb_close(std::exchange(handle_, nullptr));
    EXPECT_FALSE(open());
    simulator_.set_fault(std::nullopt);
    wait_for_count(seen.arrived, 2 + 2 * round);
    EXPECT_TRUE(open());
    EXPECT_EQ(bulk_out({1}), 1);
  }
}

}  // namespace
}  // namespace yuragi::simulators::usb
