// The bytes of USB/IP, against those that the kernel's documentation lists (usbip_protocol.rst).
#include "simulators/usb/usbip_protocol.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulators/usb/echo_device.hpp"
#include "tests/simulators/usb/usbip_bytes.hpp"

namespace yuragi::simulators::usb {
namespace {

UsbipOffer echo_offer() {
  return {"1-1", 1, summary_of(EchoDevice().descriptors())};
}

template <class Message>
Message only_message(UsbipPhase phase, const Bytes& bytes) {
  const auto taken = take_usbip_message(phase, bytes);
  EXPECT_TRUE(taken.has_value());
  EXPECT_EQ(taken->size, bytes.size());
  return std::get<Message>(taken->message.value());
}

TEST(UsbipProtocol, ReadsTheTwoQuestions) {
  only_message<UsbipListRequest>(UsbipPhase::kRequests, kUsbipRequestList);
  EXPECT_EQ(only_message<UsbipImportRequest>(UsbipPhase::kRequests, usbip_request_import("1-1")).bus_id, "1-1");
  const std::string longest(32, 'x');  // no zero behind it
  EXPECT_EQ(only_message<UsbipImportRequest>(UsbipPhase::kRequests, usbip_request_import(longest)).bus_id, longest);
}

TEST(UsbipProtocol, ReadsTransfers) {
  // The control transfer that the kernel's documentation shows: the first 64 bytes of the device descriptor.
  const Bytes bytes = {0, 0, 0, 1,    0, 0, 0x0D, 0x05, 0, 1, 0, 0x0F, 0, 0, 0, 1, 0,    0, 0, 0, 0, 0, 2,    0,
                       0, 0, 0, 0x40, 0, 0, 0,    0,    0, 0, 0, 0,    0, 0, 0, 0, 0x80, 6, 0, 1, 0, 0, 0x40, 0};
  const auto submit = only_message<UsbipSubmit>(UsbipPhase::kTransfers, bytes);
  EXPECT_EQ(submit.number, 0x0D05U);
  EXPECT_TRUE(submit.is_to_host);
  EXPECT_EQ(submit.endpoint, 0);
  EXPECT_EQ(submit.length, 64U);
  EXPECT_EQ(submit.setup.request_type, 0x80);
  EXPECT_EQ(submit.setup.value, 0x0100);
  EXPECT_EQ(submit.setup.length, 64);
  EXPECT_TRUE(submit.data.empty());

  const auto sent = only_message<UsbipSubmit>(UsbipPhase::kTransfers, usbip_submit_out(9, 2, {1, 2, 3}));
  EXPECT_FALSE(sent.is_to_host);
  EXPECT_EQ(sent.data, (Bytes{1, 2, 3}));

  const auto unlink = only_message<UsbipUnlink>(UsbipPhase::kTransfers, usbip_unlink(10, 9));
  EXPECT_EQ(unlink.number, 10U);
  EXPECT_EQ(unlink.unlinked, 9U);
}

TEST(UsbipProtocol, WaitsForTheRestOfAMessageWhereverItIsCut) {
  const auto check = [](UsbipPhase phase, const Bytes& whole) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto taken = take_usbip_message(phase, std::span(whole).first(size));
      ASSERT_TRUE(taken.has_value());
      EXPECT_FALSE(taken->message) << size;
      EXPECT_EQ(taken->size, 0U);
    }
  };
  check(UsbipPhase::kRequests, usbip_request_import("1-1"));
  check(UsbipPhase::kTransfers, usbip_submit_out(1, 2, Bytes(64)));
}

TEST(UsbipProtocol, RefusesWhatCannotBeServed) {
  const auto refuses = [](UsbipPhase phase, Bytes bytes, std::size_t at, std::uint8_t value) {
    bytes.at(at) = value;
    return !take_usbip_message(phase, bytes).has_value();
  };
  EXPECT_TRUE(refuses(UsbipPhase::kRequests, kUsbipRequestList, 1, 0x06)) << "another version";
  EXPECT_TRUE(refuses(UsbipPhase::kRequests, kUsbipRequestList, 3, 0x07)) << "another question";
  const Bytes in = usbip_submit_in(1, 1, 8);
  EXPECT_TRUE(refuses(UsbipPhase::kTransfers, in, 3, 3)) << "another command";
  EXPECT_TRUE(refuses(UsbipPhase::kTransfers, in, 19, 16)) << "an end point above 15";
  EXPECT_TRUE(refuses(UsbipPhase::kTransfers, in, 35, 4)) << "isochronous packets";
  EXPECT_TRUE(refuses(UsbipPhase::kTransfers, in, 24, 0x7F)) << "two gigabytes";
  EXPECT_TRUE(refuses(UsbipPhase::kTransfers, in, 24, 0x80)) << "a negative length";
  EXPECT_FALSE(refuses(UsbipPhase::kTransfers, in, 3, 1));
}

TEST(UsbipProtocol, ListsDevicesAsTheKernelReadsThem) {
  const Bytes reply = usbip_list_reply(std::array{echo_offer(), echo_offer()});
  EXPECT_EQ(reply.size(), 12U + 2U * (312U + 2U * 4U));
  EXPECT_EQ((Bytes{reply.begin(), reply.begin() + 12}), (Bytes{1, 0x11, 0, 5, 0, 0, 0, 0, 0, 0, 0, 2}));
  const std::span record = std::span(reply).subspan(12, 312);
  EXPECT_STREQ(reinterpret_cast<const char*>(record.data() + 256), "1-1");
  EXPECT_THAT(
      std::vector(record.begin() + 288, record.end()),
      testing::ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 2, 0x12, 0x09, 0x57, 0xD1, 0x01, 0x00, 0, 0, 0, 1, 1, 2));
  EXPECT_THAT(std::vector(reply.begin() + 324, reply.begin() + 332), testing::ElementsAre(3, 0, 0, 0, 0xFF, 0, 0, 0));
}

TEST(UsbipProtocol, AnswersAnImport) {
  const UsbipOffer offer = echo_offer();
  EXPECT_EQ(usbip_import_reply(&offer, false).size(), 8U + 312U);
  EXPECT_EQ(usbip_import_reply(&offer, true), (Bytes{1, 0x11, 0, 3, 0, 0, 0, 2}));
  EXPECT_EQ(usbip_import_reply(nullptr, false), (Bytes{1, 0x11, 0, 3, 0, 0, 0, 4}));
}

TEST(UsbipProtocol, AnswersTransfers) {
  Bytes expected(48);
  expected[3] = 3;
  expected[7] = 5;
  expected[27] = 2;
  expected.insert(expected.end(), {0xAB, 0xCD});
  EXPECT_EQ(usbip_submit_reply(5, kUsbipDone, 2, Bytes{0xAB, 0xCD}), expected);

  Bytes unlinked(48);
  unlinked[3] = 4;
  unlinked[7] = 6;
  unlinked[20] = unlinked[21] = unlinked[22] = 0xFF;
  unlinked[23] = 0x98;  // -104
  EXPECT_EQ(usbip_unlink_reply(6, kUsbipUnlinked), unlinked);
}

}  // namespace
}  // namespace yuragi::simulators::usb
