#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/base/result.hpp"
#include "simulators/usb/usb_device.hpp"
#include "simulators/usb/usb_standard.hpp"

namespace yuragi::simulators::usb {

// USB/IP, version 1.1.1, from the server's side: a host's messages, read from bytes, and the replies to them, as bytes.
// Pure. Bytes from the host are hostile. Source: Linux Documentation/usb/usbip_protocol.rst.

/// A connection begins with one request about the server, and carries a device's transfers once one was imported.
enum class UsbipPhase : std::uint8_t { kRequests, kTransfers };

/// Requests the list of devices.
struct UsbipListRequest {};

/// Requests a device.
struct UsbipImportRequest {
  std::string bus_id;
};

/// A transfer, to be answered by a UsbipReply of the same number.
struct UsbipSubmit {
  std::uint32_t number = 0;
  std::uint8_t endpoint = 0;
  bool is_to_host = false;
  std::uint32_t length = 0;  ///< how much the host sends, or would receive
  SetupPacket setup;
  Bytes data;  ///< what it sends
};

/// Cancels the transfer of that number.
struct UsbipUnlink {
  std::uint32_t number = 0;
  std::uint32_t unlinked = 0;
};

using UsbipMessage = std::variant<UsbipListRequest, UsbipImportRequest, UsbipSubmit, UsbipUnlink>;

/// The message at the beginning of some bytes, and its size; nullopt and 0 if more bytes are needed.
struct UsbipTaken {
  std::optional<UsbipMessage> message;
  std::size_t size = 0;
};

/// The longest transfer that is accepted.
inline constexpr std::uint32_t kUsbipLongestTransfer = 64 * 1024;

/// Reads the first message. The failure's text states why these bytes cannot be USB/IP, or which request no simulated
/// device supports; the connection must then be closed.
Result<UsbipTaken, Failure> take_usbip_message(UsbipPhase phase, std::span<const std::uint8_t> bytes);

/// A device that is offered.
struct UsbipOffer {
  std::string bus_id;  ///< "1-1"
  std::uint32_t device_number = 1;
  Summary summary;
};

Bytes usbip_list_reply(std::span<const UsbipOffer> offers);
/// `offer` is nullptr if the device does not exist, or if another host has it (`is_taken`).
Bytes usbip_import_reply(const UsbipOffer* offer, bool is_taken);

/// Statuses of transfers: the kernel's error numbers, negative.
inline constexpr std::int32_t kUsbipDone = 0;
inline constexpr std::int32_t kUsbipStalled = -32;    // EPIPE
inline constexpr std::int32_t kUsbipUnlinked = -104;  // ECONNRESET

/// `data` is what the host receives; `size` the bytes transferred, in either direction.
Bytes usbip_submit_reply(std::uint32_t number, std::int32_t status, std::size_t size,
                         std::span<const std::uint8_t> data);
Bytes usbip_unlink_reply(std::uint32_t number, std::int32_t status);

}  // namespace yuragi::simulators::usb
