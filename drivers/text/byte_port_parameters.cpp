#include "drivers/text/byte_port_parameters.hpp"

#include <array>
#include <stdexcept>

#include "drivers/sensor/serial_or_tcp.hpp"

namespace yuragi::drivers::text {
namespace {

constexpr std::array<std::string_view, 4> kByteTransports = {"serial", "tcp", "udp", "file"};
constexpr std::array<std::string_view, 3> kByteParities = {"none", "even", "odd"};

const std::vector<Parameter>& parameters_of_every_port() {
  static const std::vector<Parameter> kParameters = {
      {.name = "transport",
       .unit = "",
       .default_value = std::string("serial"),
       .help = "serial: a serial port; tcp: a server to connect to; udp: datagrams sent to this machine; file: a file "
               "or named pipe",
       .choices = kByteTransports},
      {.name = "device",
       .unit = "",
       .default_value = std::string(""),
       .help = "serial: the port, preferably by its stable name in /dev/serial/by-id"},
      {.name = "baud",
       .unit = "bit/s",
       .default_value = std::int64_t{9600},
       .min = bus::kBytePortBauds.front(),
       .max = bus::kBytePortBauds.back(),
       .help = "serial: as set in the device; NMEA 0183 has 4800, most anemometers 9600 or 19200"},
      {.name = "data_bits",
       .unit = "",
       .default_value = std::int64_t{8},
       .min = 7,
       .max = 8,
       .help = "serial: data bits of each character"},
      {.name = "parity",
       .unit = "",
       .default_value = std::string("none"),
       .help = "serial: parity bit of each character",
       .choices = kByteParities},
      {.name = "stop_bits",
       .unit = "",
       .default_value = std::int64_t{1},
       .min = 1,
       .max = 2,
       .help = "serial: stop bits of each character"},
      {.name = "host",
       .unit = "",
       .default_value = std::string(""),
       .help = "tcp: name or address of the server; udp: the local address to listen at, or a multicast address; "
               "empty: all addresses of this machine"},
      {.name = "port",
       .unit = "",
       .default_value = std::int64_t{10110},
       .min = 1,
       .max = 65535,
       .help = "tcp, udp: 10110 is registered for NMEA 0183"},
      {.name = "sender",
       .unit = "",
       .default_value = std::string(""),
       .help = "udp: accept datagrams from these only: addresses and nets (192.168.1.0/24) separated by commas; empty: "
               "from any; at most 100 readings a second are taken"},
      {.name = "file", .unit = "", .default_value = std::string(""), .help = "file: path of a file or named pipe"},
      {.name = "play_rate",
       .unit = "Hz",
       .default_value = 0.0,
       .min = 0.0,
       .max = 1e6,
       .help = "file: 0 follows what is appended to it; otherwise it is played once from its beginning, with this many "
               "readings per second"},
      {.name = "request",
       .unit = "",
       .default_value = std::string(""),
       .help = "request for one reading, with its line end (\"?\\r\\n\"); empty: the format's own",
       .takes_control_characters = true},
      {.name = "poll_interval",
       .unit = "s",
       .default_value = 0.0,
       .min = 0.0,
       .max = 3600.0,
       .help = "interval between requests; 0: the device sends without requests"},
      {.name = "response_timeout",
       .unit = "s",
       .default_value = 0.5,
       .min = 0.05,
       .max = 60.0,
       .help = "longest wait for the reply to a request"},
      {.name = "silence_timeout",
       .unit = "s",
       .default_value = 0.0,
       .min = 0.0,
       .max = 86400.0,
       .help = "a device that is silent for this long is opened again; 0: ten times its usual pause between readings, "
               "at least 6 s, doubled after each attempt without a reading"},
  };
  return kParameters;
}

/// Of a transport that is neither a serial line nor a server that has one.
bus::BytePortAddress address_without_a_line(const ParameterValues& values, std::string_view transport) {
  bus::BytePortAddress address;
  address.host = values.text("host");
  address.port = static_cast<std::uint16_t>(values.integer("port"));
  if (transport == "websocket") {
    address.kind = bus::BytePortKind::kWebSocket;
    if (address.host.empty())
      throw std::runtime_error("host: is missing; transport websocket needs a server to connect to");
  } else if (transport == "udp") {
    address.kind = bus::BytePortKind::kUdp;
  } else if (transport == "can") {
    address.kind = bus::BytePortKind::kCan;
    address.path = values.text("interface");
    if (address.path.empty()) throw std::runtime_error("interface: is missing; transport can needs one, such as can0");
  } else {
    address.kind = bus::BytePortKind::kFile;
    address.path = values.text("file");
    if (address.path.empty()) throw std::runtime_error("file: is missing; transport file needs its path");
  }
  return address;
}

}  // namespace

std::vector<Parameter> with_byte_port_parameters(std::vector<Parameter> own, double delay_after_open_s) {
  std::vector<Parameter> all = std::move(own);
  const auto& others = parameters_of_every_port();
  all.insert(all.end(), others.begin(), others.end());
  all.push_back(
      {.name = "delay_after_open",
       .unit = "s",
       .default_value = delay_after_open_s,
       .min = 0.0,
       .max = 60.0,
       .help = "messages are discarded for this long after opening; an Arduino restarts whenever its port is opened"});
  return all;
}

bus::BytePortAddress byte_port_address_of(const ParameterValues& values) {
  const std::string& transport = values.text("transport");
  bus::BytePortAddress address = transport == "serial" || transport == "tcp"
                                     ? sensor::serial_or_tcp_address(values)
                                     : address_without_a_line(values, transport);
  address.data_bits = static_cast<int>(values.integer("data_bits"));
  address.parity = values.text("parity") == "even" ? 'E' : values.text("parity") == "odd" ? 'O' : 'N';
  address.stop_bits = static_cast<int>(values.integer("stop_bits"));
  address.senders = values.text("sender");
  address.is_played = values.number("play_rate") > 0.0;

  const bool can_be_polled =
      address.kind == bus::BytePortKind::kSerial || address.kind == bus::BytePortKind::kTcpClient;
  if (values.number("poll_interval") > 0.0 && !can_be_polled) {
    throw std::runtime_error("poll_interval: transport " + transport + " cannot send; a request needs serial or tcp");
  }
  return address;
}

std::vector<sensor::DeviceClaim> byte_port_claims(const ParameterValues& values) {
  return sensor::claims_of(bus::sole_device_of(byte_port_address_of(values)));
}

sensor::SelectedPart reference_part(const ParameterValues& values) {
  const std::string& reference = values.text("reference");
  return {.key = "reference", .value = reference == "auto" ? "" : reference};
}

}  // namespace yuragi::drivers::text
