// Wind of a Signal K server by its WebSocket or TCP stream, or of devices that send Signal K deltas by UDP. The format
// is described with its decoder: drivers/decode/marine/signalk.hpp. A server sends its hello and then nothing, until a
// client subscribes (Signal K specification, subscription protocol; by WebSocket: subscribe=none):
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
#include "engine/base/fields.hpp"

namespace yuragi::drivers::text {
namespace {

constexpr std::string_view kOwnVessel = "vessels.self";
constexpr std::string_view kSignalKStream = "/signalk/v1/stream?subscribe=none";
constexpr std::uint16_t kWebSocketPort = 3000;
constexpr std::uint16_t kTcpPort = 8375;

constexpr std::array<std::string_view, 5> kSignalKTransports = {"websocket", "tcp", "udp", "serial", "file"};

struct SignalKKeys {
  std::string source;
  std::string context;
  std::string path;
};

const Fields<SignalKKeys> kSignalKFields = {
    {{.name = "source",
      .default_value = std::string(""),
      .help = "accept only this source, as named in the server's $source (n2k.105); empty: any"},
     &SignalKKeys::source},
    {{.name = "context",
      .default_value = std::string(""),
      .help = "the vessel, as deltas name it (vessels.urn:mrn:imo:mmsi:230099999); empty: the server's own"},
     &SignalKKeys::context},
    {{.name = "path",
      .default_value = std::string(kSignalKStream),
      .help = "websocket: the stream's path on the server"},
     &SignalKKeys::path},
    Parameter{.name = "token",
              .default_value = Secret(),
              .help = "websocket: the token, if the server requires one, from its \"Access Requests\"; sent "
                      "unencrypted (no TLS); or one of token_file and token_env, which keep it out of this file"},
    Parameter{.name = "token_file",
              .default_value = std::string(""),
              .help = "websocket: a file that holds the token, at most 4096 bytes; its mode should be 0640 or stricter",
              .is_secret_file = true},
    Parameter{.name = "token_env",
              .default_value = std::string(""),
              .help = "websocket: the environment variable that holds the token"},
};

std::vector<Parameter> signalk_parameters() {
  std::vector<Parameter> all =
      with_byte_port_parameters(together(kSignalKFields.parameters(), chosen_wind_parameters()), 0.0);
  for (Parameter& parameter : all) {
    if (parameter.name == "transport") {
      parameter.default_value = std::string("tcp");
      parameter.choices = kSignalKTransports;
      parameter.help =
          "websocket: a server's stream, with or without a token; tcp: a server's stream without a token; udp: deltas "
          "sent to this machine; serial, file: lines of deltas";
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
      parameter.help = "websocket, tcp, udp: 0: a server's usual port, 3000 for websocket, otherwise 8375";
    }
  }
  return all;
}
const std::vector<Parameter> kSignalKParameters = signalk_parameters();

/// Characters that JSON must escape.
bool needs_escape(char c) {
  return c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' ';
}

/// Characters allowed between blanks in a line of HTTP.
bool is_visible(char c) {
  return c > ' ' && c <= '~';
}

/// In place of 0.
void set_usual_port(bus::BytePortAddress& address) {
  if (address.port == 0) address.port = address.kind == bus::BytePortKind::kWebSocket ? kWebSocketPort : kTcpPort;
}

SensorSettings signalk_text_settings_of(const ParameterValues& values) {
  SensorSettings text = text_sensor_settings_of(values);
  set_usual_port(text.address);
  return text;
}

std::vector<sensor::Endpoint> signalk_endpoints(const ParameterValues& values) {
  bus::BytePortAddress address = byte_port_address_of(values);
  set_usual_port(address);
  return sensor::endpoints_at(address);
}

void set_up_websocket(bus::BytePortAddress& address, const std::string& path, const ParameterValues& values) {
  address.path = path;
  if (!address.path.starts_with('/') || !std::ranges::all_of(address.path, is_visible))
    throw std::runtime_error("path: is not a path on a server; allowed: a path such as " + std::string(kSignalKStream));
  address.token = sensor::secret_of(values, "token");
  if (!std::ranges::all_of(address.token.reveal(), is_visible))
    throw std::runtime_error("token: is not a token: it contains blanks or other characters that a token cannot have");
}

}  // namespace

SignalKSensorSettings signalk_sensor_settings_of(const ParameterValues& values) {
  const SignalKKeys keys = kSignalKFields.of(values);
  SignalKSensorSettings settings{.text = signalk_text_settings_of(values),
                                 .source = keys.source,
                                 .context = keys.context,
                                 .wind = chosen_wind_settings_of(values)};
  settings.text.longest_line = decode::marine::kMaxDelta;
  const bool is_websocket = settings.text.address.kind == bus::BytePortKind::kWebSocket;
  if (is_websocket) set_up_websocket(settings.text.address, keys.path, values);
  if (settings.text.poll_interval > Nanoseconds::zero())
    throw std::runtime_error("poll_interval: a server sends without requests; leave it out");
  if (std::ranges::any_of(settings.context, needs_escape))
    throw std::runtime_error(
        "context: is not the name of a vessel; allowed: a name such as vessels.urn:mrn:imo:mmsi:230099999");
  settings.text.greeting =
      fmt::format("{{\"context\":\"{}\",\"subscribe\":[{{\"path\":\"environment.wind.*\",\"policy\":\"instant\"}}]}}{}",
                  settings.context.empty() ? kOwnVessel : settings.context, is_websocket ? "" : "\r\n");
  return settings;
}

namespace {

Result<sensor::SimulatedDevice, Failure> signalk_simulated(const ParameterValues& values) {
  const std::string& reference = values.text("reference");
  if (reference != "auto" && reference != "relative")
    return Failure{"yuragi-sim simulates a Signal K server that sends only the apparent wind: set reference"};
  sensor::SimulatedDevice simulated = sensor::simulated_by_tcp("signalk", values);
  // The simulator's own names, which are no fault of the configuration.
  simulated.values.set("source", std::string());
  simulated.values.set("context", std::string());
  simulated.north_offset_deg = values.number("north_offset");
  return simulated;
}

}  // namespace

extern const sensor::DriverDescription kSignalKDriver;
const sensor::DriverDescription kSignalKDriver{
    .name = "signalk",
    .summary = "wind of a Signal K server (WebSocket or TCP stream), or of devices that send deltas by UDP",
    .parameters = kSignalKParameters,
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      const SignalKSensorSettings settings = signalk_sensor_settings_of(values);
      return std::make_unique<SignalKSensor>(settings, bus::make_byte_port(settings.text.address));
    },
    .find_in_network = find_signalk_servers,
    .endpoints = signalk_endpoints,
    .selection =
        [](const ParameterValues& values) {
          const SignalKKeys keys = kSignalKFields.of(values);
          const SensorSettings text = signalk_text_settings_of(values);
          const bool is_websocket = text.address.kind == bus::BytePortKind::kWebSocket;
          return text_selection(
              text, {{.key = "path", .value = is_websocket ? keys.path : ""},
                     {.key = "context", .value = keys.context.empty() ? std::string(kOwnVessel) : keys.context},
                     {.key = "source", .value = keys.source},
                     reference_part(chosen_wind_settings_of(values))});
        },
    .simulated = signalk_simulated,
    .formats = "signalk"};

}  // namespace yuragi::drivers::text
