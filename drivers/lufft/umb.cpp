// Lufft's VENTUS and V200A, and its weather stations WS200-UMB to WS800-UMB, by the UMB protocol in its binary form,
// which they leave the factory with: RS-485 at 19200 8N1, or a server in the network that has such a line.
// drivers/SOURCES.md S13.1. One request asks for all channels (drivers/decode/lufft/umb.hpp):
//
//   request                      reply                          for
//   2Fh, number, channels        2Fh, status, the channels      the wind and what else the station measures
#include <array>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/lufft/umb_sensor.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/serial_or_tcp.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::lufft {
namespace {

using bus::BytePortAddress;

/// In the order of BytePortKind.
constexpr std::array<std::string_view, 2> kUmbTransports = {"serial", "tcp"};

struct UmbKeys {
  UmbSettings settings;
  unsigned device_class = 0;
  std::uint8_t id = 0;
};

auto of_settings(auto member) {
  return member_of(&UmbKeys::settings, member);
}
auto of_address(auto member) {
  return member_of(&UmbKeys::settings, &UmbSettings::address, member);
}

const Fields<UmbKeys> kUmbFields = {
    {{.name = "transport",
      .default_value = std::string("serial"),
      .help = "serial: an RS-485 adapter; tcp: a serial device server in the network",
      .choices = kUmbTransports},
     of_address(&BytePortAddress::kind)},
    {{.name = "device",
      .default_value = std::string(""),
      .help = "serial: the port, preferably by its stable name in /dev/serial/by-id"},
     of_address(&BytePortAddress::path)},
    {{"baud", "bit/s", std::int64_t{19200}, bus::kBytePortBauds.front(), bus::kBytePortBauds.back(),
      "serial: as set in the device (by the factory to 19200); 8 data bits, no parity, 1 stop bit"},
     of_address(&BytePortAddress::baud)},
    {{.name = "host", .default_value = std::string(""), .help = "tcp: name or address of the server"},
     of_address(&BytePortAddress::host)},
    {{"port", "", std::int64_t{9750}, 1, 65535, "tcp: as set in the server"}, of_address(&BytePortAddress::port)},
    {{"class", "", std::int64_t{7}, 1, 14,
      "device class: 7 for a weather station WS200-UMB to WS800-UMB, 8 for a VENTUS or V200A"},
     &UmbKeys::device_class},
    {{"id", "", std::int64_t{1}, 1, 255, "its id on the line, as set in the device"}, &UmbKeys::id},
    {{"poll_interval", "s", 1.0, 0.2, 3600.0,
      "interval between requests; weather stations have a new wind each second, a VENTUS up to four"},
     of_settings(&UmbSettings::poll_interval),
     from_seconds},
    {{"response_timeout", "s", 0.5, 0.05, 60.0, "maximum wait for a reply"},
     of_settings(&UmbSettings::response_timeout),
     from_seconds},
};

}  // namespace

UmbSettings umb_settings_of(const ParameterValues& values) {
  UmbKeys keys = kUmbFields.of(values);
  sensor::check_serial_or_tcp(keys.settings.address);
  keys.settings.device = decode::lufft::umb_address(keys.device_class, keys.id);
  return keys.settings;
}

namespace {

Result<sensor::SimulatedDevice, Failure> umb_simulated(const ParameterValues& values) {
  const UmbKeys keys = kUmbFields.of(values);
  return sensor::simulated_by_tcp("umb", values,
                                  {"--class", std::to_string(keys.device_class), "--id", std::to_string(keys.id)});
}

}  // namespace

extern const sensor::DriverDescription kUmbDriver;
const sensor::DriverDescription kUmbDriver{
    .name = "umb",
    .summary = "Lufft VENTUS, V200A and weather stations WS200 to WS800, with the binary UMB protocol",
    .parameters = kUmbFields.parameters(),
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      const UmbSettings settings = umb_settings_of(values);
      return std::make_unique<UmbSensor>(settings, bus::make_byte_port(settings.address));
    },
    .find = [] { return sensor::find_behind_serial_ports(); },
    .endpoints =
        [](const ParameterValues& values) { return sensor::endpoints_at(kUmbFields.of(values).settings.address); },
    .selection =
        [](const ParameterValues& values) {
          const UmbKeys keys = kUmbFields.of(values);
          return sensor::selection_at(keys.settings.address,
                                      {{.key = "class", .value = std::to_string(keys.device_class)},
                                       {.key = "id", .value = std::to_string(keys.id)}});
        },
    .stated_value =
        [](const ParameterValues&) {
          // Channel 401, each second's value; 400, "actual", of a VENTUS, which has a new one four times a second.
          return std::optional(sensor::StatedValue{.value = wind::ReadingValue::kInstant,
                                                   .source = "Lufft WS manual 6.8: channels 400, 401"});
        },
    .simulated = umb_simulated,
    .formats = "umb-binary"};

}  // namespace yuragi::drivers::lufft
