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

namespace yuragi::drivers::lufft {
namespace {

constexpr std::array<std::string_view, 2> kUmbTransports = {"serial", "tcp"};

const std::array kUmbParameters = {
    Parameter{.name = "transport",
              .unit = "",
              .default_value = std::string("serial"),
              .help = "serial: an RS-485 adapter; tcp: a serial device server in the network",
              .choices = kUmbTransports},
    Parameter{.name = "device",
              .unit = "",
              .default_value = std::string(""),
              .help = "serial: the port, preferably by its stable name in /dev/serial/by-id"},
    Parameter{.name = "baud",
              .unit = "bit/s",
              .default_value = std::int64_t{19200},
              .min = bus::kBytePortBauds.front(),
              .max = bus::kBytePortBauds.back(),
              .help = "serial: as set in the device, which leaves the factory with 19200; 8 data bits, no parity, 1 "
                      "stop bit"},
    Parameter{
        .name = "host", .unit = "", .default_value = std::string(""), .help = "tcp: name or address of the server"},
    Parameter{.name = "port",
              .unit = "",
              .default_value = std::int64_t{9750},
              .min = 1,
              .max = 65535,
              .help = "tcp: as set in the server"},
    Parameter{.name = "class",
              .unit = "",
              .default_value = std::int64_t{7},
              .min = 1,
              .max = 14,
              .help = "what it is: 7: a weather station WS200-UMB to WS800-UMB; 8: a VENTUS or V200A"},
    Parameter{.name = "id",
              .unit = "",
              .default_value = std::int64_t{1},
              .min = 1,
              .max = 255,
              .help = "its id on the line, as set in the device"},
    Parameter{.name = "poll_interval",
              .unit = "s",
              .default_value = 1.0,
              .min = 0.2,
              .max = 3600.0,
              .help = "interval between requests; weather stations have a new wind each second, a VENTUS up to four"},
    Parameter{.name = "response_timeout",
              .unit = "s",
              .default_value = 0.5,
              .min = 0.05,
              .max = 60.0,
              .help = "longest wait for a reply"},
};

}  // namespace

UmbSettings umb_settings_of(const ParameterValues& values) {
  UmbSettings settings;
  settings.address = sensor::serial_or_tcp_address(values);
  settings.device = decode::lufft::umb_address(static_cast<unsigned>(values.integer("class")),
                                               static_cast<std::uint8_t>(values.integer("id")));
  settings.poll_interval = from_seconds(values.number("poll_interval"));
  settings.response_timeout = from_seconds(values.number("response_timeout"));
  return settings;
}

extern const sensor::DriverDescription kUmbDriver;
const sensor::DriverDescription kUmbDriver{
    .name = "umb",
    .summary = "Lufft VENTUS, V200A and weather stations WS200 to WS800, by the binary UMB protocol",
    .parameters = kUmbParameters,
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      const UmbSettings settings = umb_settings_of(values);
      return std::make_unique<UmbSensor>(settings, bus::make_byte_port(settings.address));
    },
    .find = [] { return sensor::find_behind_serial_ports(); },
    .claims =
        [](const ParameterValues& values) {
          return sensor::claims_of(bus::sole_device_of(umb_settings_of(values).address));
        },
    .selection =
        [](const ParameterValues& values) {
          return sensor::selection_at(umb_settings_of(values).address,
                                      {{.key = "class", .value = std::to_string(values.integer("class"))},
                                       {.key = "id", .value = std::to_string(values.integer("id"))}});
        },
    .stated_value =
        [](const ParameterValues&) {
          // Channel 401, each second's value; 400, "actual", of a VENTUS, which has a new one four times a second.
          return std::optional(sensor::StatedValue{.value = wind::ReadingValue::kInstant,
                                                   .source = "Lufft WS manual 6.8: channels 400, 401"});
        }};

}  // namespace yuragi::drivers::lufft
