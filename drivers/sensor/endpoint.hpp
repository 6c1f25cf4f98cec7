#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/bus/byte_port.hpp"

namespace yuragi::drivers::sensor {

/// The kind of a sensor's other end.
enum class EndpointKind : std::uint8_t {
  kSerialPort,
  kHid,  ///< a USB device, by the system's HID driver
  kUsb,  ///< a USB device, by its raw messages
  kSoundCard,
  kServer,   ///< a device or program that is connected to, by TCP
  kBroker,   ///< of MQTT
  kUdpPort,  ///< of this machine, at which datagrams are received
  kTcpPort,  ///< of this machine, at which a station connects
  kFile,
};

/// Something outside of this program that a sensor needs.
struct Endpoint {
  EndpointKind kind = EndpointKind::kSerialPort;
  /// As in the configuration: "/dev/ttyUSB0", "192.168.1.20:502", ":50222"; empty: whatever is found.
  std::string name{};
  /// Its identity, if only one sensor can have it: "serial port /dev/ttyUSB0"; empty: several can.
  std::string claim{};
  bool is_shared = false;  ///< sensors of one driver share the claim; of a UDP port other programs, too
};

/// Returns what a byte port connects to; empty for a CAN bus, to which all may listen. Touches no device.
std::vector<Endpoint> endpoints_at(const bus::BytePortAddress& address);

}  // namespace yuragi::drivers::sensor
