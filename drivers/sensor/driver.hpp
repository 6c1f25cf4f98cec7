#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/decoded_wind.hpp"
#include "drivers/sensor/endpoint.hpp"
#include "drivers/sensor/found_device.hpp"
#include "drivers/sensor/network_search.hpp"
#include "drivers/sensor/sensor.hpp"
#include "drivers/sensor/simulated_device.hpp"
#include "drivers/sensor/stated_value.hpp"
#include "drivers/sensor/value_selection.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::sensor {

/// The line that a sensor shares with others is in use with other settings, at least until they have ended.
class LineInUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A device that a driver knows by name, and who confirms that what the driver knows of it is right.
struct KnownDevice {
  std::string name;    ///< in a configuration
  std::string device;  ///< for people
  std::vector<std::string_view> confirmed_by = {};
  std::string unconfirmed = {};           ///< what nobody confirms; empty: all is confirmed
  std::optional<StatedValue> value = {};  ///< what its speed is; nullopt: unknown
};

/// The other quantities that a device measures, by its data sheet.
struct PromisedQuantities {
  bool direction = false;
  bool gust = false;
};

/// How a sensor is calibrated.
enum class CalibrationMeans : std::uint8_t {
  kFactors,     ///< by gain, offset and north offset of [sensor.calibration]
  kSoundLevel,  ///< by the level of its sound beside another anemometer
};

/// A format of `yuragi decode` without options, each of whose messages is decoded by itself.
struct MessageFormat {
  std::string_view name;
  bool is_text = false;      ///< lines of text; otherwise bytes, given as hexadecimal digits
  std::string_view unit;     ///< what one message is
  std::string_view devices;  ///< that send it
  std::string_view example;  ///< a command line, without `yuragi decode`
  Result<decode::DecodedWind, decode::Refusal> (*decode)(decode::ByteSpan message) noexcept;
};

/// A family of sensors: one constant `kXDriver` in its own file, listed in its folder's CMakeLists.txt.
struct DriverDescription {
  std::string_view name;
  std::string_view summary;
  std::span<const Parameter> parameters;
  /// Constructs a sensor from resolved values, without touching the device: poll() does that. Throws
  /// std::runtime_error, saying what to do, if the values contradict each other or name a missing file.
  std::unique_ptr<Sensor> (*open)(const ParameterValues& values);
  /// Finds plugged-in devices that this driver can read; nullptr if nothing can be plugged in. Opens devices only
  /// briefly.
  std::vector<FoundDevice> (*find)() = nullptr;
  /// Searches the local networks for stations that it can read, for as long as the search takes; nullptr if it cannot.
  /// Sends only the search's requests. Throws FailureError if the network cannot be searched.
  std::vector<FoundDevice> (*find_in_network)(const NetworkSearch& search) = nullptr;
  /// Returns what a sensor of these values needs, without touching it; nullptr: nothing. The doctor checks whether it
  /// exists, and two sensors that claim the same are refused. Does not throw, even for values that open() refuses.
  std::vector<Endpoint> (*endpoints)(const ParameterValues& values) = nullptr;
  /// By which type senders find a sensor at its endpoints in the network (RFC 6763): "_osc._udp"; empty: by none.
  std::string_view service_type = {};
  /// Which values a sensor of these values reads, without touching its device, of values that open() takes; nullptr:
  /// no two sensors read the same. Two sensors of the driver are refused if one's selection covers the other's.
  ValueSelection (*selection)(const ParameterValues& values) = nullptr;
  /// The devices that it knows by name; nullptr: none.
  std::vector<KnownDevice> (*known_devices)() = nullptr;
  /// Returns for how long, s, the silence of a sensor that sends only changes means that nothing has changed; 0, or
  /// nullptr: it sends all. A longer silence counts as silence.
  double (*unchanged_for_s)(const ParameterValues& values) = nullptr;
  /// What the readings of a sensor of these values should have, of values that open() takes: if it does not come, that
  /// is a fault. nullptr: only what has come is expected.
  PromisedQuantities (*promises)(const ParameterValues& values) = nullptr;
  /// Returns what the speed of a sensor of these values is, as documented by the maker or the protocol; nullptr, or
  /// nullopt, if that is unknown. Does not touch the device. Does not throw, even for values that open() refuses.
  std::optional<StatedValue> (*stated_value)(const ParameterValues& values) = nullptr;
  /// How yuragi-sim plays the device of a sensor of these values, or why it does not, for a technician. A device has
  /// its factory settings, or those of the sensor's entry; never those of a profile: one with mistakes is to show.
  Result<SimulatedDevice, Failure> (*simulated)(const ParameterValues& values) = nullptr;
  /// What a person must set at the device itself: lines of text; empty: nothing.
  std::string_view device_setup = {};
  /// It plays a recording: never to be taken for the live wind.
  bool plays_recordings = false;
  /// The calibrations that `yuragi calibrate` offers.
  CalibrationMeans calibration = CalibrationMeans::kFactors;
  /// The formats of `yuragi decode` that read its messages.
  std::span<const MessageFormat> message_formats = {};
  /// Those with options of the command (daemon/tools/decode), with blanks between them; empty: none.
  std::string_view formats = {};
  /// A relative sensor: only the fluctuations of its readings are valid, not their scale, which depends on where it
  /// is mounted. It is compared with no other sensor, and beside others only its gusts count, unless configured
  /// otherwise.
  bool is_relative = false;
};

/// Every driver (generated).
std::span<const DriverDescription* const> driver_table();

/// The driver of this name; nullptr: there is none. Thread-safe: yes.
inline const DriverDescription* find_driver(std::string_view name) {
  for (const DriverDescription* const driver : driver_table()) {
    if (driver->name == name) return driver;
  }
  return nullptr;
}

/// The driver that plays recordings.
inline const DriverDescription& recording_driver() {
  for (const DriverDescription* const driver : driver_table()) {
    if (driver->plays_recordings) return *driver;
  }
  throw std::logic_error("no driver plays recordings");
}

}  // namespace yuragi::drivers::sensor
