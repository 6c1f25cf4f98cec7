// What a port does for every device: waiting, order, silence, unplugging.
#include "simulators/usb/usb_port.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulators/usb/steady_wind.hpp"

namespace yuragi::simulators::usb {
namespace {

using testing::Contains;
using testing::IsEmpty;
using testing::SizeIs;

Transfer in_transfer(std::uint64_t id, std::uint8_t endpoint, std::size_t max_size = 64) {
  return {.id = id, .endpoint = endpoint, .is_to_host = true, .setup = {}, .data = {}, .max_size = max_size};
}
Transfer out_transfer(std::uint64_t id, Bytes data) {
  return {.id = id, .endpoint = 2, .is_to_host = false, .setup = {}, .data = std::move(data), .max_size = 0};
}
Transfer control_transfer(std::uint64_t id, const SetupPacket& setup, Bytes data = {}) {
  return {.id = id,
          .endpoint = 0,
          .is_to_host = setup.is_to_host(),
          .setup = setup,
          .data = std::move(data),
          .max_size = 0};
}

constexpr SetupPacket kVendorRequest = {0xC0, 0x42, 0, 0, 8};
constexpr SetupPacket kGetDeviceDescriptor = {0x80, 6, 0x0100, 0, 18};
constexpr SetupPacket kSetFeature = {0x21, 9, 0x0300, 0, 8};

class UsbPortTest : public testing::Test {
 protected:
  UsbPortTest() { port_->advance(0.0, std::nullopt); }
  std::unique_ptr<Port> port_ = echo_port();
};

TEST_F(UsbPortTest, AReadWaitsUntilTheDeviceHasSomethingToSay) {
  port_->submit(in_transfer(1, 1));
  port_->submit(in_transfer(2, 1));
  const auto first = port_->take_outcomes();
  ASSERT_THAT(first, SizeIs(1));
  EXPECT_EQ(first[0].id, 1U);
  EXPECT_THAT(first[0].data, testing::ElementsAre('W', 1, 0, 0, 0, 750 & 0xFF, 750 >> 8, 120));

  port_->advance(0.005, std::nullopt);
  EXPECT_THAT(port_->take_outcomes(), IsEmpty());
  port_->advance(0.011, std::nullopt);
  const auto second = port_->take_outcomes();
  ASSERT_THAT(second, SizeIs(1));
  EXPECT_EQ(second[0].id, 2U);
}

TEST_F(UsbPortTest, OneEndPointThatWaitsKeepsNoOtherWaiting) {
  port_->submit(in_transfer(1, 2));
  port_->submit(control_transfer(2, kVendorRequest));
  const auto outcomes = port_->take_outcomes();
  ASSERT_THAT(outcomes, SizeIs(1));
  EXPECT_EQ(outcomes[0].id, 2U);

  port_->submit(out_transfer(3, {0x0F}));
  EXPECT_THAT(port_->take_outcomes(), SizeIs(1)) << "what was sent";
  const auto echo = port_->take_outcomes();
  ASSERT_THAT(echo, SizeIs(1));
  EXPECT_EQ(echo[0].data, Bytes{0xF0});
}

TEST_F(UsbPortTest, AWaitingTransferCanBeCancelledOnce) {
  port_->submit(in_transfer(1, 2));
  EXPECT_TRUE(port_->cancel(1));
  EXPECT_FALSE(port_->cancel(1));
  port_->submit(out_transfer(2, {1}));
  EXPECT_THAT(port_->take_outcomes(), SizeIs(1)) << "only what was sent";
}

TEST_F(UsbPortTest, RefusalsAreTold) {
  port_->submit(out_transfer(1, {0xFF}));
  port_->submit(in_transfer(2, 7));
  port_->submit(control_transfer(3, {0xC0, 0x43, 0, 0, 8}));
  const auto outcomes = port_->take_outcomes();
  ASSERT_THAT(outcomes, SizeIs(3));
  for (const Outcome& outcome : outcomes) {
    EXPECT_TRUE(outcome.is_refused) << outcome.id;
    EXPECT_EQ(outcome.size, 0U);
  }
}

TEST_F(UsbPortTest, ASilentDeviceHearsAndSaysOnlyWhatItIs) {
  port_->advance(1.0, core::FaultKind::kSilence);
  port_->submit(in_transfer(1, 1));
  port_->submit(control_transfer(2, kGetDeviceDescriptor));
  port_->submit(control_transfer(3, kSetFeature, {8, 7, 6, 5, 4, 3, 2, 1}));
  port_->submit(control_transfer(4, kVendorRequest));
  port_->submit(out_transfer(5, {1, 2, 3}));
  std::vector<std::uint64_t> ended;
  for (const Outcome& outcome : port_->take_outcomes()) ended.push_back(outcome.id);
  EXPECT_THAT(ended, testing::ElementsAre(2, 3, 5));

  port_->advance(2.0, std::nullopt);
  port_->submit(in_transfer(6, 2));
  ended.clear();
  for (const Outcome& outcome : port_->take_outcomes()) ended.push_back(outcome.id);
  EXPECT_THAT(ended, testing::ElementsAre(1, 4)) << "what it would have said in its silence is lost";
}

TEST_F(UsbPortTest, AnUnpluggedDeviceForgetsAllTransfersAndTakesNone) {
  port_->submit(in_transfer(1, 2));
  port_->advance(1.0, core::FaultKind::kUnplug);
  EXPECT_FALSE(port_->is_plugged_in());
  port_->submit(control_transfer(2, kGetDeviceDescriptor));
  EXPECT_THAT(port_->take_outcomes(), IsEmpty());
  port_->advance(2.0, std::nullopt);
  EXPECT_TRUE(port_->is_plugged_in());
  EXPECT_THAT(port_->take_outcomes(), IsEmpty());
}

TEST_F(UsbPortTest, ItsDevicesFaultsAndItsOwnAreKnown) {
  for (const core::FaultKind kind :
       {core::FaultKind::kSilence, core::FaultKind::kUnplug, core::FaultKind::kSpike, core::FaultKind::kGarbage}) {
    EXPECT_THAT(port_->known_faults(), Contains(kind));
  }
  port_->advance(1.0, core::FaultKind::kGarbage);
  port_->submit(in_transfer(1, 1));
  EXPECT_EQ(port_->take_outcomes().at(0).data, Bytes(EchoDevice::kReportSize, 0xA5));
  port_->advance(2.0, core::FaultKind::kException);  // of which the device knows nothing
  port_->submit(in_transfer(2, 1));
  EXPECT_EQ(port_->take_outcomes().at(0).data.front(), 'W');
}

}  // namespace
}  // namespace yuragi::simulators::usb
