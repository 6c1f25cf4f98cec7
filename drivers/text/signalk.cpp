// Wind of a Signal K server by its TCP stream, or of devices that send Signal K deltas by UDP. The format is described
// with its decoder: drivers/decode/marine/signalk.hpp. A server sends its hello and then nothing, until a client says
// what it wants (Signal K specification, subscription protocol):
//
//   {"context":"vessels.self","subscribe":[{"path":"environment.wind.*","policy":"instant"}]}
#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/text/byte_port_parameters.hpp"
#include "drivers/text/signalk_sensor.hpp"

namespace yuragi::drivers::text {
namespace {

constexpr std::string_view kOwnVessel = "vessels.self";
constexpr std::int64_t kSignalKPort = 8375;

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
  };
  std::ranges::move(chosen_wind_parameters(), std::back_inserter(own));
  std::vector<Parameter> all = with_byte_port_parameters(std::move(own), 0.0);
  for (Parameter& parameter : all) {
    if (parameter.name == "transport") parameter.default_value = std::string("tcp");
    if (parameter.name == "port") {
      parameter.default_value = kSignalKPort;
      parameter.help = "tcp, udp: 8375 is a server's TCP stream";
    }
  }
  return all;
}
const std::vector<Parameter> kSignalKParameters = signalk_parameters();

/// What a JSON text cannot hold as it is.
bool needs_escape(char c) {
  return c == '"' || c == '\\' || (c >= 0 && c < ' ');
}

}  // namespace

SignalKSensorSettings signalk_sensor_settings_of(const ParameterValues& values) {
  SignalKSensorSettings settings;
  settings.text = text_sensor_settings_of(values);
  settings.text.longest_line = decode::marine::kLongestDelta;
  settings.source = values.text("source");
  settings.context = values.text("context");
  settings.wind = chosen_wind_settings_of(values);
  if (settings.text.poll_interval > Nanoseconds::zero())
    throw std::runtime_error("poll_interval: a server sends without requests; leave it out");
  if (std::ranges::any_of(settings.context, needs_escape))
    throw std::runtime_error("context: is no name of a vessel; allowed: such as vessels.urn:mrn:imo:mmsi:230099999");
  settings.text.greeting = fmt::format(
      "{{\"context\":\"{}\",\"subscribe\":[{{\"path\":\"environment.wind.*\",\"policy\":\"instant\"}}]}}\r\n",
      settings.context.empty() ? kOwnVessel : settings.context);
  return settings;
}

extern const sensor::DriverDescription kSignalKDriver;
const sensor::DriverDescription kSignalKDriver{
    .name = "signalk",
    .summary = "wind of a Signal K server (TCP stream), or of devices that send deltas by UDP",
    .parameters = kSignalKParameters,
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      const SignalKSensorSettings settings = signalk_sensor_settings_of(values);
      return std::make_unique<SignalKSensor>(settings, bus::make_byte_port(settings.text.address));
    },
    .find = nullptr,
    .claims = byte_port_claims};

}  // namespace yuragi::drivers::text
