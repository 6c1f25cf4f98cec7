#include "drivers/text/byte_port_parameters.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "drivers/sensor/serial_or_tcp.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::text {
namespace {

using bus::BytePortAddress;
using bus::BytePortKind;

constexpr std::array<std::string_view, 4> kByteTransports = {"serial", "tcp", "udp", "file"};
constexpr std::array<std::string_view, 3> kByteParities = {"none", "even", "odd"};

struct BytePortKeys {
  SensorSettings text;
  std::string file;
};

auto of_text(auto member) {
  return member_of(&BytePortKeys::text, member);
}
auto of_address(auto member) {
  return member_of(&BytePortKeys::text, &SensorSettings::address, member);
}

/// The transports of all drivers, in the order of BytePortKind.
constexpr std::array<std::string_view, 6> kKinds = {"serial", "tcp", "udp", "websocket", "file", "can"};

BytePortKind kind_of(const std::string& transport) {
  return static_cast<BytePortKind>(std::ranges::find(kKinds, transport) - kKinds.begin());
}

char parity_letter(const std::string& word) {
  return word == "even" ? 'E' : word == "odd" ? 'O' : 'N';
}

const Fields<BytePortKeys>& byte_port_fields() {
  static const Fields<BytePortKeys> kPortFields = {
      {{.name = "transport",
        .default_value = std::string("serial"),
        .help = "serial: a serial port; tcp: a server to connect to; udp: datagrams sent to this machine; file: a file "
                "or named pipe",
        .choices = kByteTransports},
       of_address(&BytePortAddress::kind),
       kind_of},
      {{.name = "device",
        .default_value = std::string(""),
        .help = "serial: the port, preferably by its stable name in /dev/serial/by-id"},
       of_address(&BytePortAddress::path)},
      {{"baud", "bit/s", std::int64_t{9600}, bus::kBytePortBauds.front(), bus::kBytePortBauds.back(),
        "serial: as set in the device; NMEA 0183 has 4800, most anemometers 9600 or 19200"},
       of_address(&BytePortAddress::baud)},
      {{"data_bits", "", std::int64_t{8}, 7, 8, "serial: data bits of each character"},
       of_address(&BytePortAddress::data_bits)},
      {{.name = "parity",
        .default_value = std::string("none"),
        .help = "serial: parity bit of each character",
        .choices = kByteParities},
       of_address(&BytePortAddress::parity),
       parity_letter},
      {{"stop_bits", "", std::int64_t{1}, 1, 2, "serial: stop bits of each character"},
       of_address(&BytePortAddress::stop_bits)},
      {{.name = "host",
        .default_value = std::string(""),
        .help = "tcp: name or address of the server; udp: the local address to listen at, or a multicast address; "
                "empty: all addresses of this machine"},
       of_address(&BytePortAddress::host)},
      {{"port", "", std::int64_t{10110}, 1, 65535, "tcp, udp: 10110 is registered for NMEA 0183"},
       of_address(&BytePortAddress::port)},
      {{.name = "sender",
        .default_value = std::string(""),
        .help = "udp: accept datagrams only from these: addresses and networks (192.168.1.0/24) separated by commas; "
                "empty: from any; at most 100 readings a second are accepted"},
       of_address(&BytePortAddress::senders)},
      {{.name = "file", .default_value = std::string(""), .help = "file: path of a file or named pipe"},
       &BytePortKeys::file},
      {{"play_rate", "Hz", 0.0, 0.0, 1e6,
        "file: 0 follows what is appended to it; otherwise it is played once from its beginning, with this many "
        "readings per second"},
       of_text(&SensorSettings::play_rate_hz)},
      {{.name = "request",
        .default_value = std::string(""),
        .help = "request for one reading, with its line end (\"?\\r\\n\"); empty: the format's own",
        .takes_control_characters = true},
       of_text(&SensorSettings::request)},
      {{"poll_interval", "s", 0.0, 0.0, 3600.0, "interval between requests; 0: the device sends without requests"},
       of_text(&SensorSettings::poll_interval),
       from_seconds},
      {{"response_timeout", "s", 0.5, 0.05, 60.0, "maximum wait for the reply to a request"},
       of_text(&SensorSettings::response_timeout),
       from_seconds},
      {{"silence_timeout", "s", 0.0, 0.0, 86400.0,
        "a device that is silent for this long is reopened; 0: ten times its usual pause between readings, at "
        "least 6 s, doubled after each attempt without a reading"},
       of_text(&SensorSettings::silence_timeout),
       from_seconds},
      {{"delay_after_open", "s", 0.0, 0.0, 60.0,
        "messages are discarded for this long after opening; an Arduino restarts each time its port is opened"},
       of_text(&SensorSettings::delay_after_open),
       from_seconds},
  };
  return kPortFields;
}

/// Of a port that is neither a serial line nor a server that has one: its path.
std::string path_of(const BytePortKeys& keys, const ParameterValues& values) {
  const BytePortAddress& address = keys.text.address;
  if (address.kind == BytePortKind::kWebSocket && address.host.empty())
    throw std::runtime_error("host: is missing; transport websocket needs a server to connect to");
  if (address.kind == BytePortKind::kCan) {
    const std::string& interface = values.text("interface");
    if (interface.empty()) throw std::runtime_error("interface: is missing; transport can needs one, such as can0");
    return interface;
  }
  if (address.kind == BytePortKind::kFile && keys.file.empty())
    throw std::runtime_error("file: is missing; transport file needs its path");
  return address.kind == BytePortKind::kFile ? keys.file : "";
}

}  // namespace

std::vector<Parameter> with_byte_port_parameters(std::span<const Parameter> own, double delay_after_open_s) {
  std::vector<Parameter> all = together(own, byte_port_fields().parameters());
  all.back().default_value = delay_after_open_s;
  return all;
}

SensorSettings text_sensor_settings_of(const ParameterValues& values) {
  BytePortKeys keys = byte_port_fields().of(values);
  SensorSettings& text = keys.text;
  BytePortAddress& address = text.address;
  address.is_played = text.play_rate_hz > 0.0;
  const bool has_line = address.kind == BytePortKind::kSerial || address.kind == BytePortKind::kTcpClient;
  if (has_line) {
    sensor::check_serial_or_tcp(address);
  } else {
    address.path = path_of(keys, values);
  }
  if (text.poll_interval > Nanoseconds::zero() && !has_line) {
    throw std::runtime_error(fmt::format("poll_interval: transport {} cannot send; a request needs serial or tcp",
                                         kKinds.at(static_cast<std::size_t>(address.kind))));
  }
  if (address.kind != BytePortKind::kSerial) text.delay_after_open = Nanoseconds::zero();
  return text;
}

bus::BytePortAddress byte_port_address_of(const ParameterValues& values) {
  const BytePortKeys keys = byte_port_fields().of(values);
  bus::BytePortAddress address = keys.text.address;
  if (address.kind == BytePortKind::kFile) address.path = keys.file;
  return address;
}

std::vector<sensor::Endpoint> byte_port_endpoints(const ParameterValues& values) {
  return sensor::endpoints_at(byte_port_address_of(values));
}

}  // namespace yuragi::drivers::text
