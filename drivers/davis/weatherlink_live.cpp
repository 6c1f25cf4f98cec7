// The WeatherLink Live of Davis stations, in the local network: Davis, "WeatherLink Live Local API"; drivers/SOURCES.md
// S10.2.
//
//     GET /v1/current_conditions         all values of its stations; at most every 10 s
//     GET /v1/real_time?duration=300    the wind every 2.5 s for that many seconds, broadcast to UDP port 22222
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/davis/weatherlink_live_finder.hpp"
#include "drivers/davis/weatherlink_live_sensor.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::davis {
namespace {

const Fields<WeatherLinkLiveSettings> kWeatherLinkLiveFields = {
    {{.name = "host",
      .default_value = std::string(""),
      .help = "name or address of the WeatherLink Live; its broadcasts reach only its own network"},
     [](WeatherLinkLiveSettings& settings) -> std::string& { return settings.http.host; }},
    {{"http_port", "", std::int64_t{80}, 1, 65535, "its HTTP port"},
     [](WeatherLinkLiveSettings& settings) -> std::uint16_t& { return settings.http.port; }},
    {{"port", "", std::int64_t{22222}, 1, 65535,
      "the UDP port that it broadcasts to; without broadcasts there is only one reading every 10 s"},
     [](WeatherLinkLiveSettings& settings) -> std::uint16_t& { return settings.broadcasts.port; }},
    {{"transmitter", "", std::int64_t{0}, 0, 8,
      "the station's id, 1 to 8, as set on it; 0: the first that reports wind"},
     &WeatherLinkLiveSettings::transmitter},
};

WeatherLinkLiveSettings configured(const ParameterValues& values) {
  WeatherLinkLiveSettings settings = kWeatherLinkLiveFields.of(values);
  settings.http.kind = bus::BytePortKind::kTcpClient;
  settings.broadcasts.kind = bus::BytePortKind::kUdp;
  settings.broadcasts.is_port_shared = true;  // by the sensors of one device's transmitters
  return settings;
}

std::vector<sensor::Endpoint> weatherlink_live_endpoints(const ParameterValues& values) {
  const WeatherLinkLiveSettings settings = configured(values);
  std::vector<sensor::Endpoint> endpoints = sensor::endpoints_at(settings.http);
  endpoints.push_back(sensor::endpoints_at(settings.broadcasts).front());
  return endpoints;
}

std::unique_ptr<sensor::Sensor> open_weatherlink_live(const ParameterValues& values) {
  const WeatherLinkLiveSettings settings = weatherlink_live_settings_of(values);
  return std::make_unique<WeatherLinkLiveSensor>(settings, bus::make_byte_port(settings.http),
                                                 bus::make_byte_port(settings.broadcasts));
}

}  // namespace

WeatherLinkLiveSettings weatherlink_live_settings_of(const ParameterValues& values) {
  WeatherLinkLiveSettings settings = configured(values);
  if (settings.http.host.empty()) throw std::runtime_error("host: is missing; give the WeatherLink Live's address");
  return settings;
}

namespace {

Result<sensor::SimulatedDevice, Failure> weatherlink_live_simulated(const ParameterValues& values) {
  const std::string broadcasts = fmt::format("127.0.0.1:{}", configured(values).broadcasts.port);
  sensor::SimulatedDevice simulated =
      sensor::simulated_server("weatherlink-live", values, {"--udp", broadcasts, "--interval", "1"});
  simulated.values.set("transmitter", std::int64_t{0});
  simulated.port_key = "http_port";  // `port` is where its broadcasts come
  return simulated;
}

}  // namespace

extern const sensor::DriverDescription kWeatherLinkLiveDriver;
const sensor::DriverDescription kWeatherLinkLiveDriver{
    .name = "weatherlink",
    .summary = "the WeatherLink Live of Davis stations, over the local network",
    .parameters = kWeatherLinkLiveFields.parameters(),
    .open = open_weatherlink_live,
    .find_in_network = find_weatherlink_lives,
    .endpoints = weatherlink_live_endpoints,
    .selection =
        [](const ParameterValues& values) {
          const WeatherLinkLiveSettings settings = weatherlink_live_settings_of(values);
          return sensor::ValueSelection{
              .device = "WeatherLink Live " + bus::device_of(settings.http),
              .device_keys = "host, http_port",
              .parts = {{.key = "transmitter",
                         .value = settings.transmitter == 0 ? "" : std::to_string(settings.transmitter)}}};
        },
    .simulated = weatherlink_live_simulated,
    .formats = "weatherlink"};

}  // namespace yuragi::drivers::davis
