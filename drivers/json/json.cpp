// Wind in the JSON of a web server that is polled: public weather services, Shelly, ESPHome, Home Assistant's REST
// interface (drivers/SOURCES.md S9.4).
#include <array>
#include <functional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "drivers/bus/http_client.hpp"
#include "drivers/decode/json_pointer.hpp"
#include "drivers/json/headers_file.hpp"
#include "drivers/json/json_sensor.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "engine/base/address.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::json {
namespace {

using bus::HttpResource;
using decode::network::JsonPlaces;

auto of(auto... members) {
  return member_of(members...);
}

const Fields<Settings> kJsonFields = {
    {{.name = "url",
      .default_value = Secret(),
      .help = "what is polled, http or https; never shown, because keys may stand in it. Redirects are not followed"},
     of(&Settings::resource, &HttpResource::url)},
    {{"port", "", std::int64_t{0}, 0, 65535, "the server's port; 0: that of url"},
     of(&Settings::resource, &HttpResource::port)},
    {{.name = "speed",
      .default_value = std::string(""),
      .help = "JSON pointer to the speed, such as /wind/speed or /observations/0/wind"},
     of(&Settings::places, &JsonPlaces::speed)},
    {{.name = "direction",
      .default_value = std::string(""),
      .help = "JSON pointer to the direction, in degrees or as a point of the compass (NW); empty: none"},
     of(&Settings::places, &JsonPlaces::direction)},
    {{.name = "gust", .default_value = std::string(""), .help = "JSON pointer to the gust; empty: none"},
     of(&Settings::places, &JsonPlaces::gust)},
    {{.name = "time",
      .default_value = std::string(""),
      .help = "JSON pointer to the time of the observation: an answer with the same time is not a new reading; empty: "
              "none"},
     of(&Settings::places, &JsonPlaces::time)},
    {{.name = "speed_unit",
      .default_value = std::string("m/s"),
      .help = "the unit of speed and gust",
      .choices = sensor::kSpeedUnitNames},
     of(&Settings::places, &JsonPlaces::metres_per_second),
     sensor::metres_per_second_in},
    {{"every", "s", 60.0, 1.0, 3600.0,
      "time between two polls; after an error up to ten times as long, and as long as the server asks for (at most an "
      "hour)"},
     &Settings::every,
     from_seconds},
    {{"interval", "s", 0.0, 0.0, 86400.0,
      "how often the source has a new value: without `time`, unchanged values count as a new reading only after this "
      "long; without a new reading the wind counts as unchanged for twice as long; 0: ten times `every`"},
     &Settings::interval,
     from_seconds},
    {{"silence", "s", 5400.0, 1.0, 86400.0, "with `time`: an observation that is older is no longer the wind"},
     &Settings::silence,
     from_seconds},
    {{"response_timeout", "s", 10.0, 0.1, 60.0, "maximum wait for a whole answer"},
     of(&Settings::resource, &HttpResource::timeout),
     from_seconds},
    Parameter{.name = "headers_file",
              .default_value = std::string(""),
              .help = "a file with headers of the request, a line \"Name: value\" each, such as \"X-Api-Key: ...\"; at "
                      "most 4096 bytes; its mode should be 0640 or stricter",
              .is_secret_file = true},
    {{.name = "ca_file",
      .default_value = std::string(""),
      .help = "CA certificates (PEM) that the server's certificate must be from; empty: those of the system"},
     of(&Settings::resource, &HttpResource::ca_file)},
};

/// The server, for people.
std::string place_of(const Settings& settings, const bus::UrlParts& url) {
  return to_string(Address{url.host, settings.resource.port != 0 ? settings.resource.port : url.port});
}

Result<bus::UrlParts, Failure> url_of(const Settings& settings) {
  if (settings.resource.url.is_empty()) return Failure{"is missing; give the address of the JSON"};
  return bus::url_parts(settings.resource.url.reveal());
}

void check_pointers(const JsonPlaces& places) {
  const std::array<std::pair<std::string_view, const std::string*>, 4> named = {
      {{"speed", &places.speed}, {"direction", &places.direction}, {"gust", &places.gust}, {"time", &places.time}}};
  if (places.speed.empty())
    throw std::runtime_error("speed: is missing; give the JSON pointer to the speed, such as /wind/speed");
  for (const auto& [key, pointer] : named) {
    if (decode::is_json_pointer(*pointer)) continue;
    throw std::runtime_error(
        fmt::format("{}: \"{}\" is not a JSON pointer, which begins with a slash, as in /wind/speed", key, *pointer));
  }
}

/// Throws std::runtime_error, naming the key, for what cannot be polled.
Settings settings_of(const ParameterValues& values) {
  Settings settings = kJsonFields.of(values);
  settings.resource.url = values.secret("url");
  settings.resource.max_body = decode::network::kMaxJsonAnswer;
  if (const auto url = url_of(settings); !url) throw std::runtime_error("url: " + url.error().message);
  check_pointers(settings.places);
  return settings;
}

std::unique_ptr<sensor::Sensor> open_json(const ParameterValues& values) {
  Settings settings = settings_of(values);
  if (const std::string& file = values.text("headers_file"); !file.empty()) {
    auto headers = headers_in_file(file);
    if (!headers) throw std::runtime_error("headers_file: " + headers.error().message);
    settings.resource.headers = std::move(*headers);
  }
  return std::make_unique<Sensor>(settings, place_of(settings, *url_of(settings)),
                                  bus::make_http_client(settings.resource));
}

std::vector<sensor::Endpoint> json_endpoints(const ParameterValues& values) {
  const Settings settings = kJsonFields.of(values);
  const auto url = url_of(settings);
  return {{.kind = sensor::EndpointKind::kServer, .name = url ? place_of(settings, *url) : std::string()}};
}

/// Of path and query a number stands for them: they are not to be shown.
sensor::ValueSelection json_selection(const ParameterValues& values) {
  const Settings settings = settings_of(values);
  const bus::UrlParts url = *url_of(settings);
  return {.device = "server " + place_of(settings, url),
          .parts = {{.key = "url",
                     .value = fmt::format("#{:08x}",
                                          static_cast<std::uint32_t>(std::hash<std::string>{}(url.path_and_query)))},
                    {.key = "speed", .value = settings.places.speed}}};
}

/// Does one of the pointers lead into the value of another one?
bool do_places_overlap(const JsonPlaces& places) {
  const std::array all = {&places.speed, &places.direction, &places.gust, &places.time};
  for (const std::string* const outer : all) {
    for (const std::string* const inner : all) {
      if (outer != inner && !outer->empty() && (*inner + "/").starts_with(*outer + "/")) return true;
    }
  }
  return false;
}

Result<sensor::SimulatedDevice, Failure> json_simulated(const ParameterValues& values) {
  const JsonPlaces places = kJsonFields.of(values).places;
  if (places.speed.empty() || do_places_overlap(places))
    return Failure{"yuragi-sim needs a `speed`, and each of speed, direction, gust and time at a place of its own"};
  sensor::SimulatedDevice simulated{.arguments = {"json", "--tcp", "127.0.0.1:0", "--interval", "1", "--unit",
                                                  values.text("speed_unit"), "--speed-at", places.speed},
                                    .values = values};
  const auto add = [&simulated](const char* option, const std::string& pointer) {
    if (!pointer.empty()) simulated.arguments.insert(simulated.arguments.end(), {option, pointer});
  };
  add("--direction-at", places.direction);
  add("--gust-at", places.gust);
  add("--time-at", places.time);
  simulated.values.set("url", Secret("http://127.0.0.1/wind.json"));
  simulated.values.set("headers_file", std::string());
  simulated.values.set("ca_file", std::string());
  simulated.values.set("every", 1.0);
  simulated.values.set("interval", 1.0);
  return simulated;
}

}  // namespace

extern const sensor::DriverDescription kJsonDriver;
const sensor::DriverDescription kJsonDriver{
    .name = "json",
    .summary = "wind in the JSON of a web server that is polled: weather services, Shelly, ESPHome, Home Assistant",
    .parameters = kJsonFields.parameters(),
    .open = open_json,
    .endpoints = json_endpoints,
    .selection = json_selection,
    .unchanged_for_s = [](const ParameterValues& values) { return 2.0 * seconds(interval_of(kJsonFields.of(values))); },
    .simulated = json_simulated};

}  // namespace yuragi::drivers::json
