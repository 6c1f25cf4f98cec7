#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "simulators/usb/usb_device.hpp"

namespace yuragi::simulators::usb {

// What a USB/IP host sends, as bytes.

inline const Bytes kUsbipRequestList = {0x01, 0x11, 0x80, 0x05, 0, 0, 0, 0};

inline Bytes usbip_request_import(const std::string& bus_id) {
  Bytes bytes(40);
  bytes[0] = 0x01;
  bytes[1] = 0x11;
  bytes[2] = 0x80;
  bytes[3] = 0x03;
  std::copy_n(bus_id.begin(), std::min<std::size_t>(bus_id.size(), 32), bytes.begin() + 8);
  return bytes;
}

/// The head of a transfer, of a number and a length below 256.
inline Bytes usbip_head(std::uint8_t command, std::uint8_t number, bool is_to_host, std::uint8_t endpoint,
                        std::uint8_t length) {
  Bytes bytes(48);
  bytes[3] = command;
  bytes[7] = number;
  bytes[11] = 1;
  bytes[15] = is_to_host ? 1 : 0;
  bytes[19] = endpoint;
  bytes[27] = length;
  return bytes;
}

inline Bytes usbip_submit_in(std::uint8_t number, std::uint8_t endpoint, std::uint8_t length) {
  return usbip_head(1, number, true, endpoint, length);
}

inline Bytes usbip_submit_out(std::uint8_t number, std::uint8_t endpoint, const Bytes& data) {
  Bytes bytes = usbip_head(1, number, false, endpoint, static_cast<std::uint8_t>(data.size()));
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

inline Bytes usbip_unlink(std::uint8_t number, std::uint8_t unlinked) {
  Bytes bytes = usbip_head(2, number, false, 0, 0);
  bytes[23] = unlinked;
  return bytes;
}

}  // namespace yuragi::simulators::usb
