// The standard requests, as a host sends them while it gets to know a device; and nonsense.
#include "simulators/usb/usb_standard.hpp"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulators/usb/echo_device.hpp"

namespace yuragi::simulators::usb {
namespace {

using testing::ElementsAre;

class UsbStandardTest : public testing::Test {
 protected:
  std::optional<Bytes> get(std::uint8_t type, std::uint8_t request, std::uint16_t value, std::uint16_t index,
                           std::uint16_t length) {
    return pipe_.control({type, request, value, index, length}, {});
  }
  std::optional<Bytes> set(std::uint8_t type, std::uint8_t request, std::uint16_t value, std::uint16_t index = 0) {
    return pipe_.control({type, request, value, index, 0}, {});
  }

  EchoDevice device_;
  ControlPipe pipe_{device_};
};

TEST_F(UsbStandardTest, TellsEachDescriptor) {
  EXPECT_EQ(get(0x80, 6, 0x0100, 0, 64), device_.descriptors().device);
  EXPECT_EQ(get(0x80, 6, 0x0200, 0, 4096), device_.descriptors().configuration);
  EXPECT_EQ(get(0x81, 6, 0x2200, 0, 4096), device_.descriptors().hid_report);
  EXPECT_EQ(get(0x81, 6, 0x2100, 0, 64), (Bytes{9, 0x21, 0x11, 0x01, 0, 1, 0x22, 27, 0}));
}

TEST_F(UsbStandardTest, TellsOnlyAsMuchAsIsAskedFor) {
  EXPECT_EQ(get(0x80, 6, 0x0100, 0, 8)->size(), 8U);
  EXPECT_EQ(get(0x80, 6, 0x0200, 0, 9)->size(), 9U);
  EXPECT_EQ(get(0xC0, 0x42, 0, 0, 3), (Bytes{'V', 'E', 'N'}));
}

TEST_F(UsbStandardTest, TellsStringsInTwoBytesACharacter) {
  EXPECT_EQ(get(0x80, 6, 0x0300, 0, 255), (Bytes{4, 3, 0x09, 0x04}));
  EXPECT_EQ(get(0x80, 6, 0x0302, 0x0409, 255), (Bytes{10, 3, 'E', 0, 'c', 0, 'h', 0, 'o', 0}));
}

TEST_F(UsbStandardTest, RefusesWhatTheDeviceHasNot) {
  EXPECT_FALSE(get(0x80, 6, 0x0304, 0x0409, 255)) << "a string";
  EXPECT_FALSE(get(0x80, 6, 0x0600, 0, 10)) << "high speed";
  EXPECT_FALSE(get(0x80, 6, 0x0201, 0, 9)) << "a second configuration";
  EXPECT_FALSE(get(0x81, 6, 0x2200, 1, 64)) << "a report descriptor of the other interface";
  EXPECT_FALSE(set(0x00, 9, 2)) << "a configuration";
  EXPECT_FALSE(set(0x01, 11, 1)) << "an alternate setting";
  EXPECT_FALSE(get(0xC0, 0x43, 0, 0, 8)) << "a vendor request";
}

TEST_F(UsbStandardTest, IsConfiguredByTheHost) {
  EXPECT_EQ(pipe_.configuration(), 0);
  EXPECT_TRUE(set(0x00, 5, 7)) << "an address";
  EXPECT_TRUE(set(0x00, 9, 1));
  EXPECT_EQ(pipe_.configuration(), 1);
  EXPECT_EQ(get(0x80, 8, 0, 0, 1), Bytes{1});
  EXPECT_TRUE(set(0x01, 11, 0));
  EXPECT_TRUE(set(0x02, 1, 0, 0x81)) << "the halt of an end point is cleared";
  EXPECT_EQ(get(0x82, 0, 0, 0x81, 2), (Bytes{0, 0}));
}

TEST_F(UsbStandardTest, LeavesClassAndVendorRequestsToTheDevice) {
  const Bytes feature = {1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_TRUE(pipe_.control({0x21, 9, 0x0300, 0, 8}, feature));
  EXPECT_EQ(get(0xA1, 1, 0x0300, 0, 8), feature);
}

TEST_F(UsbStandardTest, SurvivesAnyRequest) {
  std::mt19937 random(1);
  const auto any = [&random] { return static_cast<std::uint16_t>(random()); };
  for (int i = 0; i < 100'000; ++i) {
    const SetupPacket setup = {static_cast<std::uint8_t>(any()), static_cast<std::uint8_t>(any() % 16), any(), any(),
                               any()};
    const auto answer = pipe_.control(setup, Bytes(any() % 9));
    ASSERT_LE(answer.value_or(Bytes{}).size(), setup.length);
  }
}

TEST(UsbSummary, ReadsTheDescriptors) {
  const Summary summary = summary_of(EchoDevice().descriptors());
  EXPECT_EQ(summary.vendor_id, 0x1209);
  EXPECT_EQ(summary.product_id, 0x57D1);
  EXPECT_EQ(summary.release, 0x0100);
  EXPECT_EQ(summary.configuration_value, 1);
  EXPECT_EQ(summary.manufacturer, "Yuragi");
  EXPECT_EQ(summary.product, "Echo");
  EXPECT_EQ(summary.serial, "E0001");
  ASSERT_EQ(summary.interfaces.size(), 2U);
  EXPECT_EQ(summary.interfaces[0].device_class, 3);
  EXPECT_EQ(summary.interfaces[1].device_class, 0xFF);
  ASSERT_NE(summary.endpoint(0x81), nullptr);
  EXPECT_EQ(summary.endpoint(0x81)->type, 3);
  EXPECT_EQ(summary.endpoint(0x81)->max_packet_size, 8);
  EXPECT_EQ(summary.endpoint(0x83), nullptr);
}

TEST(UsbSummary, StopsWhereADescriptorMakesNoSense) {
  Descriptors cut = EchoDevice().descriptors();
  for (std::size_t size = 0; size < cut.configuration.size(); ++size) {
    Descriptors shorter = cut;
    shorter.configuration.resize(size);
    EXPECT_LE(summary_of(shorter).endpoints.size(), 3U);
  }
  cut.configuration[9] = 0;  // a descriptor of no length would never end
  EXPECT_TRUE(summary_of(cut).interfaces.empty());
  EXPECT_EQ(summary_of(Descriptors{}).vendor_id, 0);
}

}  // namespace
}  // namespace yuragi::simulators::usb
