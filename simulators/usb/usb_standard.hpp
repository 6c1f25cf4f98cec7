#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulators/usb/usb_device.hpp"

namespace yuragi::simulators::usb {

/// An interface, as the kernel lists it in sysfs, and a USB/IP server in its device list.
struct Interface {
  std::uint8_t number = 0;
  std::uint8_t device_class = 0;
  std::uint8_t subclass = 0;
  std::uint8_t protocol = 0;
};

/// An end point as the configuration describes it.
struct Endpoint {
  std::uint8_t address = 0;  ///< its number, with bit 7 set for one to the host
  std::uint8_t type = 0;     ///< 0 control, 1 isochronous, 2 bulk, 3 interrupt
  std::uint16_t max_packet_size = 0;
};

/// The fields of a device's descriptors. Missing fields are zero.
struct Summary {
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::uint16_t release = 0;  ///< bcdDevice
  std::uint8_t device_class = 0;
  std::uint8_t subclass = 0;
  std::uint8_t protocol = 0;
  std::uint8_t configurations = 0;
  std::uint8_t configuration_value = 0;
  std::string manufacturer, product, serial;
  std::vector<Interface> interfaces;
  std::vector<Endpoint> endpoints;

  /// Returns the end point of that address; nullptr if there is none.
  const Endpoint* endpoint(std::uint8_t address) const;
};

Summary summary_of(const Descriptors& descriptors);

/// Decodes the 8 bytes that begin a control transfer.
SetupPacket usb_setup_of(std::span<const std::uint8_t, 8> bytes);

/// The control pipe of a simulated device: answers the standard requests (USB 2.0 specification, 9.4) from its
/// descriptors, and passes the others to it. Any bytes may come from the host. Thread-safe: no.
class ControlPipe {
 public:
  /// `device` must outlive this.
  explicit ControlPipe(Device& device);

  /// Returns true if a request is answered here and not passed to the device.
  static bool is_standard(const SetupPacket& setup) noexcept { return (setup.request_type & 0x60U) == 0; }

  /// Like Device::control(), but never more than `setup.length` bytes.
  std::optional<Bytes> control(const SetupPacket& setup, std::span<const std::uint8_t> data);

  /// The configuration that the host has set; 0: none yet.
  std::uint8_t configuration() const noexcept { return configuration_; }

 private:
  std::optional<Bytes> standard(const SetupPacket& setup);
  std::optional<Bytes> descriptor(const SetupPacket& setup) const;

  Device& device_;
  std::uint8_t configuration_value_ = 0;
  std::uint8_t configuration_ = 0;
};

}  // namespace yuragi::simulators::usb
