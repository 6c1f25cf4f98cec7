#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulators/core/faults.hpp"
#include "simulators/core/played_wind.hpp"

namespace yuragi::simulators::usb {

using Bytes = std::vector<std::uint8_t>;

/// The 8 bytes that begin a control transfer (USB 2.0 specification, 9.3).
struct SetupPacket {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;

  bool is_to_host() const noexcept { return (request_type & 0x80U) != 0; }
};

/// A device's descriptors, as the bytes that it would send (USB 2.0 specification, 9.5 and 9.6). One configuration.
struct Descriptors {
  Bytes device;                      ///< 18 bytes
  Bytes configuration;               ///< with interfaces, HID descriptors and end points behind it
  Bytes hid_report;                  ///< of interface 0; empty: not an HID device
  std::vector<std::string> strings;  ///< ASCII; number 1 first
};

/// A simulated USB device, the same for every way to attach it (USB/IP, umockdev). Pure: no socket, no file, no clock.
/// The host is hostile: any bytes of any length may come.
///
/// Standard requests (descriptors, address, configuration) are answered for it by usb_standard.hpp: control() sees
/// class and vendor requests only. Thread-safe: no.
class Device {
 public:
  virtual ~Device() = default;

  virtual const Descriptors& descriptors() const = 0;
  virtual std::span<const core::FaultKind> known_faults() const = 0;

  /// Advances to `time_s` after the start, in that wind. Called before all other functions for that moment. Port
  /// plays kUnplug and kSilence of the whole device; the device itself plays wrong content.
  virtual void advance(double time_s, const core::PlayedMoment& wind, std::optional<core::FaultKind> fault) = 0;

  /// A control transfer. `data` is what the host sends (empty if it reads). Returns what the host receives, at most
  /// `setup.length` bytes; nullopt for a request that the device refuses (a stall).
  virtual std::optional<Bytes> control(const SetupPacket& setup, std::span<const std::uint8_t> data) = 0;

  /// The data that waits at an IN end point (its number without the direction bit), at most `max_size` bytes: one
  /// interrupt report, or bulk data. Returns nullopt if the host has to wait (NAK).
  virtual std::optional<Bytes> in(std::uint8_t endpoint, std::size_t max_size) = 0;

  /// Takes data that the host sends to an OUT end point. Returns false if it refuses it (a stall).
  virtual bool out(std::uint8_t endpoint, std::span<const std::uint8_t> data) = 0;
};

}  // namespace yuragi::simulators::usb
