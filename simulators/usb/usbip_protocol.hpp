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

namespace yuragi::sim {

// USB/IP, version 1.1.1, as a server speaks it: what a host may say, read from bytes, and what it is answered, as
// bytes. Pure; what comes from the host is hostile. Source: Linux Documentation/usb/usbip_protocol.rst.

/// A connection begins with one question about the server, and becomes the wire of a device once one was imported.
enum class UsbipPhase : std::uint8_t { kQuestions, kTransfers };

/// Which devices are there?
struct UsbipListRequest {};

/// Give me that one.
struct UsbipImportRequest {
  std::string bus_id;
};

/// A transfer, to be answered by a UsbipReply of the same number.
struct UsbipSubmit {
  std::uint32_t number = 0;
  std::uint8_t endpoint = 0;
  bool is_to_host = false;
  std::uint32_t length = 0;  ///< how much the host sends, or would take
  UsbSetup setup;
  UsbBytes data;  ///< what it sends
};

/// Forget the transfer of that number.
struct UsbipUnlink {
  std::uint32_t number = 0;
  std::uint32_t unlinked = 0;
};

using UsbipMessage = std::variant<UsbipListRequest, UsbipImportRequest, UsbipSubmit, UsbipUnlink>;

/// A message at the beginning of some bytes, and how many of them it takes; nothing, and 0, if more bytes are needed.
struct UsbipTaken {
  std::optional<UsbipMessage> message;
  std::size_t size = 0;
};

/// The longest transfer that is taken.
inline constexpr std::uint32_t kUsbipLongestTransfer = 64 * 1024;

/// Reads the first message. The failure says why these bytes cannot be USB/IP, or what no simulated device can do: the
/// connection is of no use any more.
Result<UsbipTaken, Failure> take_usbip_message(UsbipPhase phase, std::span<const std::uint8_t> bytes);

/// A device that is offered.
struct UsbipOffer {
  std::string bus_id;  ///< "1-1"
  std::uint32_t device_number = 1;
  UsbSummary summary;
};

UsbBytes usbip_list_reply(std::span<const UsbipOffer> offers);
/// `offer` is nullptr where there is no such device, or where somebody has it already.
UsbBytes usbip_import_reply(const UsbipOffer* offer, bool is_taken);

/// Statuses of transfers: the kernel's error numbers, negative.
inline constexpr std::int32_t kUsbipDone = 0;
inline constexpr std::int32_t kUsbipStalled = -32;    // EPIPE
inline constexpr std::int32_t kUsbipUnlinked = -104;  // ECONNRESET

/// `data` is what the host gets; `size` how much went, whichever way.
UsbBytes usbip_submit_reply(std::uint32_t number, std::int32_t status, std::size_t size,
                            std::span<const std::uint8_t> data);
UsbBytes usbip_unlink_reply(std::uint32_t number, std::int32_t status);

}  // namespace yuragi::sim
