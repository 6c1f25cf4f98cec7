// Bytes of USB/IP 1.1.1, all big-endian but the setup bytes of a control transfer, which are as on the wire.
//
//   request      u16 version 0x0111, u16 code, u32 status; an import adds char[32] bus id
//   its reply    the same head with the code's top bit clear; a list adds u32 count and records with 4 bytes for each
//                interface behind each, an import one record
//   record       char[256] path, char[32] bus id, u32 bus, u32 device, u32 speed, u16 vendor, u16 product, u16 release,
//                u8 class, subclass, protocol, configuration value, configurations, interfaces
//   transfer     u32 command, u32 number, u32 device, u32 direction, u32 end point; then
//     submit 1   u32 flags, u32 length, u32 start frame, u32 packets, u32 interval, u8[8] setup, the data that is sent
//     unlink 2   u32 the number that is meant, 24 bytes of nothing
//     reply 3    u32 status, u32 length, u32 start frame, u32 packets, u32 errors, 8 bytes of nothing,
//                the data that is read
//     reply 4    u32 status, 24 bytes of nothing
#include "simulators/usb/usbip_protocol.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace yuragi::simulators::usb {
namespace {

constexpr std::uint16_t kVersion = 0x0111;
constexpr std::uint16_t kRequestList = 0x8005;
constexpr std::uint16_t kRequestImport = 0x8003;
constexpr std::uint16_t kReplyList = 0x0005;
constexpr std::uint16_t kReplyImport = 0x0003;
constexpr std::uint32_t kStatusNone = 4;   // ST_NODEV
constexpr std::uint32_t kStatusTaken = 2;  // ST_DEV_BUSY

constexpr std::uint32_t kSubmit = 1;
constexpr std::uint32_t kUnlink = 2;
constexpr std::uint32_t kSubmitReply = 3;
constexpr std::uint32_t kUnlinkReply = 4;
constexpr std::uint32_t kDirectionIn = 1;
constexpr std::uint32_t kNotIsochronous = 0xFFFFFFFF;  // as the number of packets; 0 means the same

constexpr std::uint32_t kFullSpeed = 2;  // 12 Mbit/s
constexpr std::uint32_t kBus = 1;

constexpr std::size_t kRequestSize = 8;
constexpr std::size_t kBusIdSize = 32;
constexpr std::size_t kPathSize = 256;
constexpr std::size_t kTransferHeadSize = 48;

std::uint16_t usbip_word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}

std::uint32_t long_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return (std::uint32_t{usbip_word_at(bytes, at)} << 16U) | usbip_word_at(bytes, at + 2);
}

void put_word(Bytes& bytes, std::uint16_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

void put_long(Bytes& bytes, std::uint32_t value) {
  put_word(bytes, static_cast<std::uint16_t>(value >> 16U));
  put_word(bytes, static_cast<std::uint16_t>(value));
}

/// A text in a field of a fixed size, with at least one zero at its end.
void put_text(Bytes& bytes, std::string_view text, std::size_t size) {
  const std::size_t end = bytes.size() + size;
  text = text.substr(0, size - 1);
  bytes.insert(bytes.end(), text.begin(), text.end());
  bytes.resize(end);
}

void put_record(Bytes& bytes, const UsbipOffer& offer) {
  const Summary& summary = offer.summary;
  put_text(bytes, "/sys/devices/simulated/usb1/" + offer.bus_id, kPathSize);
  put_text(bytes, offer.bus_id, kBusIdSize);
  put_long(bytes, kBus);
  put_long(bytes, offer.device_number);
  put_long(bytes, kFullSpeed);
  put_word(bytes, summary.vendor_id);
  put_word(bytes, summary.product_id);
  put_word(bytes, summary.release);
  const auto interfaces = static_cast<std::uint8_t>(std::min<std::size_t>(summary.interfaces.size(), 255));
  for (const std::uint8_t byte : {summary.device_class, summary.subclass, summary.protocol, summary.configuration_value,
                                  summary.configurations, interfaces}) {
    bytes.push_back(byte);
  }
}

Bytes reply_head(std::uint16_t code, std::uint32_t status) {
  Bytes bytes;
  put_word(bytes, kVersion);
  put_word(bytes, code);
  put_long(bytes, status);
  return bytes;
}

Result<UsbipTaken, Failure> take_request(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kRequestSize) return UsbipTaken{};
  if (const std::uint16_t version = usbip_word_at(bytes, 0); version != kVersion) {
    return Failure{fmt::format("USB/IP version {:#06x}; only {:#06x} is supported", version, kVersion)};
  }
  switch (const std::uint16_t code = usbip_word_at(bytes, 2)) {
    case kRequestList:
      return UsbipTaken{UsbipListRequest{}, kRequestSize};
    case kRequestImport: {
      if (bytes.size() < kRequestSize + kBusIdSize) return UsbipTaken{};
      const auto field = bytes.subspan(kRequestSize, kBusIdSize);
      return UsbipTaken{UsbipImportRequest{{field.begin(), std::ranges::find(field, 0)}}, kRequestSize + kBusIdSize};
    }
    default:
      return Failure{fmt::format("unknown USB/IP request code {:#06x}", code)};
  }
}

Result<UsbipTaken, Failure> take_transfer(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kTransferHeadSize) return UsbipTaken{};
  const std::uint32_t command = long_at(bytes, 0);
  const std::uint32_t number = long_at(bytes, 4);
  if (command == kUnlink) return UsbipTaken{UsbipUnlink{number, long_at(bytes, 20)}, kTransferHeadSize};
  if (command != kSubmit) return Failure{fmt::format("unknown USB/IP command {}", command)};

  // A host that sends isochronous packets would go on with their list.
  const std::uint32_t packets = long_at(bytes, 32);
  if (packets != 0 && packets != kNotIsochronous) return Failure{"isochronous transfers are not supported"};
  const std::uint32_t endpoint = long_at(bytes, 16);
  if (endpoint > 15) return Failure{fmt::format("endpoint {}; there are 16", endpoint)};
  UsbipSubmit submit;
  submit.number = number;
  submit.endpoint = static_cast<std::uint8_t>(endpoint);
  submit.is_to_host = long_at(bytes, 12) == kDirectionIn;
  submit.length = long_at(bytes, 24);
  if (submit.length > kUsbipLongestTransfer) {
    return Failure{fmt::format("a transfer of {} bytes; allowed: up to {}", submit.length, kUsbipLongestTransfer)};
  }
  submit.setup = usb_setup_of(bytes.subspan<40, 8>());

  const std::size_t size = kTransferHeadSize + (submit.is_to_host ? 0 : submit.length);
  if (bytes.size() < size) return UsbipTaken{};
  const auto data = bytes.subspan(kTransferHeadSize, size - kTransferHeadSize);
  submit.data.assign(data.begin(), data.end());
  return UsbipTaken{std::move(submit), size};
}

}  // namespace

Result<UsbipTaken, Failure> take_usbip_message(UsbipPhase phase, std::span<const std::uint8_t> bytes) {
  return phase == UsbipPhase::kRequests ? take_request(bytes) : take_transfer(bytes);
}

Bytes usbip_list_reply(std::span<const UsbipOffer> offers) {
  Bytes bytes = reply_head(kReplyList, 0);
  put_long(bytes, static_cast<std::uint32_t>(offers.size()));
  for (const UsbipOffer& offer : offers) {
    put_record(bytes, offer);
    for (const Interface& interface : offer.summary.interfaces) {
      for (const std::uint8_t byte :
           {interface.device_class, interface.subclass, interface.protocol, std::uint8_t{0}}) {
        bytes.push_back(byte);
      }
    }
  }
  return bytes;
}

Bytes usbip_import_reply(const UsbipOffer* offer, bool is_taken) {
  if (offer == nullptr || is_taken) return reply_head(kReplyImport, is_taken ? kStatusTaken : kStatusNone);
  Bytes bytes = reply_head(kReplyImport, 0);
  put_record(bytes, *offer);
  return bytes;
}

Bytes usbip_submit_reply(std::uint32_t number, std::int32_t status, std::size_t size,
                         std::span<const std::uint8_t> data) {
  Bytes bytes;
  put_long(bytes, kSubmitReply);
  put_long(bytes, number);
  bytes.resize(20);
  put_long(bytes, static_cast<std::uint32_t>(status));
  put_long(bytes, static_cast<std::uint32_t>(size));
  bytes.resize(kTransferHeadSize);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

Bytes usbip_unlink_reply(std::uint32_t number, std::int32_t status) {
  Bytes bytes;
  put_long(bytes, kUnlinkReply);
  put_long(bytes, number);
  bytes.resize(20);
  put_long(bytes, static_cast<std::uint32_t>(status));
  bytes.resize(kTransferHeadSize);
  return bytes;
}

}  // namespace yuragi::simulators::usb
