// Wind of a Signal K server by its WebSocket or TCP stream, or of devices that send Signal K deltas by UDP. The format
// is described with its decoder: drivers/decode/marine/signalk.hpp. A server sends its hello and then nothing, until a
// client says what it wants (Signal K specification, subscription protocol; by WebSocket: subscribe=none):
//
//   {"context":"vessels.self","subscribe":[{"path":"environment.wind.*","policy":"instant"}]}
#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/secret_source.hpp"
#include "drivers/text/byte_port_parameters.hpp"
#include "drivers/text/signalk_finder.hpp"
#include "drivers/text/signalk_sensor.hpp"

namespace yuragi::drivers::text {
namespace {

constexpr std::string_view kOwnVessel = "vessels.self";
constexpr std::string_view kSignalKStream = "/signalk/v1/stream?subscribe=none";
constexpr std::uint16_t kWebSocketPort = 3000;
constexpr std::uint16_t kTcpPort = 8375;
/// Deltas of one message have some hundred bytes, those of many values some thousand.
constexpr std::size_t kLongestDelta = 16384;

constexpr std::array<std::string_view, 5> kSignalKTransports = {"websocket", "tcp", "udp", "serial", "file"};

std::vector<Parameter> signalk_parameters() {
  std::vector<Parameter> own = {
      {.name = "source",
       .unit = "",
       .default_value = std::string(""),
       .help = "accept only this one of the server's sources, as its deltas name it in $source (n2k.105); empty: any"},
      {.name = "context",
       .unit = "",
       .default_value = std::string(""),
       .help = "the vessel, as deltas name it (vessels.urn:mrn:imo:mmsi:230099999); empty: the server's own"},
      {.name = "path",
       .unit = "",
       .default_value = std::string(kSignalKStream),
       .help = "websocket: the stream's place on the server"},
      {.name = "token",
       .unit = "",
       .default_value = Secret(),
       .help = "websocket: the token of a server that lets nobody read without one, from its \"Access Requests\"; sent "
               "as it is (no TLS); or one of token_file and token_env, which keep it out of this file"},
      {.name = "token_file",
       .unit = "",
       .default_value = std::string(""),
       .help = "websocket: a file that holds the token, at most 4096 bytes; its mode should be 0640 or stricter",
       .is_secret_file = true},
      {.name = "token_env",
       .unit = "",
       .default_value = std::string(""),
       .help = "websocket: the environment variable that holds the token"},
  };
  std::ranges::move(chosen_wind_parameters(), std::back_inserter(own));
  std::vector<Parameter> all = with_byte_port_parameters(std::move(own), 0.0);
  for (Parameter& parameter : all) {
    if (parameter.name == "transport") {
      parameter.default_value = std::string("tcp");
      parameter.choices = kSignalKTransports;
      parameter.help =
          "websocket: a server's stream, with or without a token; tcp: a server's stream, which it has "
          "where it needs no token; udp: deltas sent to this machine; serial, file: lines of deltas";
    }
    if (parameter.name == "host") {
      parameter.help =
          "websocket, tcp: name or address of the server (`yuragi sensors list --network` looks for it); udp: the "
          "local "
          "address to listen at, or a multicast address; empty: all addresses of this machine";
    }
    if (parameter.name == "port") {
      parameter.default_value = std::int64_t{0};
      parameter.min = 0;
      parameter.help = "websocket, tcp, udp: 0 takes a server's usual one: 3000 by websocket, else 8375";
    }
  }
  return all;
}
const std::vector<Parameter> kSignalKParameters = signalk_parameters();

/// What a JSON text cannot hold as it is.
bool needs_escape(char c) {
  return c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' ';
}

/// What a line of HTTP holds between blanks.
bool is_visible(char c) {
  return c > ' ' && c <= '~';
}

bus::BytePortAddress signalk_address_of(const ParameterValues& values) {
  bus::BytePortAddress address = byte_port_address_of(values);
  if (address.port == 0) address.port = address.kind == bus::BytePortKind::kWebSocket ? kWebSocketPort : kTcpPort;
  return address;
}

void set_up_websocket(bus::BytePortAddress& address, const ParameterValues& values) {
  address.path = values.text("path");
  if (!address.path.starts_with('/') || !std::ranges::all_of(address.path, is_visible))
    throw std::runtime_error("path: is none on a server; allowed: such as " + std::string(kSignalKStream));
  address.token = sensor::secret_of(values, "token");
  if (!std::ranges::all_of(address.token.reveal(), is_visible))
    throw std::runtime_error("token: is none: it has blanks or other characters in it that no token has");
}

}  // namespace

SignalKSensorSettings signalk_sensor_settings_of(const ParameterValues& values) {
  SignalKSensorSettings settings;
  settings.text = text_sensor_settings_of(values);
  settings.text.longest_line = decode::marine::kLongestDelta;
  settings.source = values.text("source");
  settings.context = values.text("context");
  settings.wind = chosen_wind_settings_of(values);
  settings.text.address = signalk_address_of(values);
  const bool is_websocket = settings.text.address.kind == bus::BytePortKind::kWebSocket;
  if (is_websocket) set_up_websocket(settings.text.address, values);
  if (settings.text.poll_interval > Nanoseconds::zero())
    throw std::runtime_error("poll_interval: a server sends without requests; leave it out");
  if (std::ranges::any_of(settings.context, needs_escape))
    throw std::runtime_error("context: is no name of a vessel; allowed: such as vessels.urn:mrn:imo:mmsi:230099999");
  settings.text.greeting =
      fmt::format("{{\"context\":\"{}\",\"subscribe\":[{{\"path\":\"environment.wind.*\",\"policy\":\"instant\"}}]}}{}",
                  settings.context.empty() ? kOwnVessel : settings.context, is_websocket ? "" : "\r\n");
  return settings;
}

extern const sensor::DriverDescription kSignalKDriver;
const sensor::DriverDescription kSignalKDriver{
    .name = "signalk",
    .summary = "wind of a Signal K server (WebSocket or TCP stream), or of devices that send deltas by UDP",
    .parameters = kSignalKParameters,
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      const SignalKSensorSettings settings = signalk_sensor_settings_of(values);
      return std::make_unique<SignalKSensor>(settings, bus::make_byte_port(settings.text.address));
    },
    .find = nullptr,
    .find_in_network = find_signalk_servers,
    .claims =
        [](const ParameterValues& values) {
          return sensor::claims_of(bus::sole_device_of(signalk_address_of(values)));
        },
    .selection =
        [](const ParameterValues& values) {
          TextSensorSettings text = text_sensor_settings_of(values);
          text.address = signalk_address_of(values);
          const bool is_websocket = text.address.kind == bus::BytePortKind::kWebSocket;
          const std::string& context = values.text("context");
          return text_selection(text, {{.key = "path", .value = is_websocket ? values.text("path") : ""},
                                       {.key = "context", .value = context.empty() ? std::string(kOwnVessel) : context},
                                       {.key = "source", .value = values.text("source")},
                                       reference_part(values)});
        }};

}  // namespace yuragi::drivers::text
