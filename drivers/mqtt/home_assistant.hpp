#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/sensor/found_device.hpp"

namespace yuragi::drivers::mqtt {

// Home Assistant's MQTT discovery, by which ESPHome, Home Assistant's own scripts and many gateways announce what they
// publish: retained JSON on PREFIX/sensor/[NODE/]OBJECT/config, or, for a whole device, on PREFIX/device/OBJECT/config.
// Source: drivers/SOURCES.md S5.3.

enum class AnnouncedKind : std::uint8_t { kSpeed, kDirection, kGust };

/// One value about the wind that a publisher announces.
struct AnnouncedValue {
  AnnouncedKind kind = AnnouncedKind::kSpeed;
  std::string device;   ///< values of one device have the same: an identifier of the device
  std::string name;     ///< for people: the device's and the value's own
  std::string topic;    ///< that it is published on
  std::string pointer;  ///< its place in the message (JSON pointer); empty: the payload is the number
  std::string unit;     ///< of a speed or gust: one of sensor::kSpeedUnitNames
  std::string trouble;  ///< why it cannot be read as it is announced; empty: it can

  bool operator==(const AnnouncedValue&) const = default;
};

/// Returns the values of the wind in one announcement, by its device_class (wind_speed, wind_direction), or if its name
/// contains "wind" and its unit is one of speed, or the degree; empty if it is about something else, or not an
/// announcement. A speed is a gust if its name contains "gust" or "max". Never throws for any bytes. Thread-safe: yes.
std::vector<AnnouncedValue> announced_in(std::string_view topic, std::string_view payload);

/// The anemometers among them: one for each speed, with the direction and the gust of the same device. `broker` are the
/// lines of TOML to reach it.
std::vector<sensor::FoundDevice> announced_anemometers(std::span<const AnnouncedValue> values,
                                                       const std::string& broker);

/// A text as TOML writes it, in quotes.
std::string quoted_for_toml(const std::string& text);

}  // namespace yuragi::drivers::mqtt
