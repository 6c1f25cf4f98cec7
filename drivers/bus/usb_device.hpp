#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// Vendor and product id.
struct UsbId {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;

  bool operator==(const UsbId&) const = default;
};

/// "09db:00e8": for people.
std::string describe(const UsbId& id);

/// A device as the bus shows it, without being opened.
struct PluggedUsbDevice {
  UsbId id;
  std::string port;          ///< where it is plugged in: "1-2.3" is port 3 of the hub at port 2 of bus 1. Stays
  std::string serial;        ///< empty if the device has none to show
  std::string node;          ///< "/dev/bus/usb/001/005"; another one each time that it is plugged in
  bool is_permitted = true;  ///< this user may open it
};

/// The beginning of a control transfer without its length (USB 2.0 specification, 9.3).
struct UsbRequest {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
};

enum class UsbStatus : std::uint8_t {
  kDone,         ///< `size` bytes were transferred
  kTimeout,      ///< not in time
  kStalled,      ///< the device refuses this request
  kOverflow,     ///< the device sent more than was requested
  kInterrupted,  ///< interrupt() was called
  kGone,         ///< the device, or the connection to it, is lost
};

struct UsbTransfer {
  UsbStatus status = UsbStatus::kGone;
  std::size_t size = 0;
};

/// A device of a few kinds, which can be plugged in and out for as long as this lives. Carries bytes without
/// interpreting them. A test may substitute another.
///
/// Thread-safe: interrupt() alone; everything else belongs to one thread.
class UsbDevice {
 public:
  virtual ~UsbDevice() = default;

  /// Those of its kinds that are plugged in, in the order of their ports.
  virtual Result<std::vector<PluggedUsbDevice>, Failure> plugged() = 0;

  /// Returns true if a device of its kinds was plugged in since the last call. Does not wait.
  virtual bool take_arrival() = 0;

  /// Opens one of those and claims its first interface. The failure's text: why, and what to do.
  virtual Result<void, Failure> open(const PluggedUsbDevice& device) = 0;
  virtual void close() noexcept = 0;

  // Each ends within `timeout`, give or take a second on a bus that hangs. More than `data` has room for is kOverflow.

  /// A control transfer; `data` is filled if `request` reads, and sent if it writes.
  virtual UsbTransfer control(const UsbRequest& request, std::span<std::uint8_t> data, Nanoseconds timeout) = 0;
  /// A bulk transfer from or to an end point, by its number without the direction bit.
  virtual UsbTransfer read(std::uint8_t endpoint, std::span<std::uint8_t> data, Nanoseconds timeout) = 0;
  virtual UsbTransfer write(std::uint8_t endpoint, std::span<const std::uint8_t> data, Nanoseconds timeout) = 0;

  /// Ends a waiting transfer and makes all later ones end at once.
  virtual void interrupt() noexcept = 0;
};

/// The real one, by libusb, with a libusb context of its own.
std::unique_ptr<UsbDevice> make_usb_device(std::vector<UsbId> kinds);

}  // namespace yuragi::drivers::bus
