// Protocols whose messages are JSON: one in a datagram, a reply, an MQTT message, or a line.
#include <array>

#include <fmt/format.h>

#include "drivers/decode/davis/weatherlink_live.hpp"
#include "drivers/decode/marine/canboat.hpp"
#include "drivers/decode/marine/signalk.hpp"
#include "drivers/decode/network/json_wind.hpp"
#include "drivers/decode/network/tempest.hpp"
#include "drivers/decode/text/line.hpp"
#include "drivers/mqtt/mqtt_payload.hpp"
#include "engine/base/units.hpp"
#include "tests/hurt/protocol.hpp"

namespace yuragi::hurt {
namespace {

using JsonWinds = std::vector<DecodedWind>;

/// Speeds in tenths, directions in degrees.
struct JsonWind {
  int speed_tenths;
  int gust_tenths;
  int direction_deg;

  explicit JsonWind(Chance& chance)
      : speed_tenths(chance.between(1, 500)),
        gust_tenths(chance.between(speed_tenths, 600)),
        direction_deg(chance.between(1, 359)) {}
  double speed() const { return speed_tenths / 10.0; }
  double gust() const { return gust_tenths / 10.0; }
};

Message make_tempest(Chance& chance) {
  const JsonWind wind(chance);
  return {
      fmt::format(R"({{"serial_number":"ST-00000512","type":"obs_st","hub_sn":"HB-00013030","obs":[[1588948614,0.18,)"
                  R"({:.2f},{:.2f},{},6,1017.57,22.37,50.26,328,0.03,3,0.000000,0,0,0,2.410,1]],)"
                  R"("firmware_revision":129}})",
                  wind.speed(), wind.gust(), wind.direction_deg),
      wind_of(wind.speed(), wind.direction_deg, wind.gust())};
}
Message make_rapid_wind(Chance& chance) {
  const JsonWind wind(chance);
  return {fmt::format(R"({{"serial_number":"SK-00008453","type":"rapid_wind","hub_sn":"HB-00000001",)"
                      R"("ob":[1493322445,{:.1f},{}]}})",
                      wind.speed(), wind.direction_deg),
          wind_of(wind.speed(), wind.direction_deg)};
}
JsonWinds tempest_winds(std::string_view bytes) {
  const auto message = drivers::decode::network::decode_tempest(bytes);
  return message && message->wind ? JsonWinds{*message->wind} : JsonWinds();
}

Message make_weatherlink_live(Chance& chance) {
  const JsonWind wind(chance);
  return {fmt::format(R"({{"did":"001D0A711980","ts":1582669708,"conditions":[{{"lsid":288313,)"
                      R"("data_structure_type":1,"txid":7,"wind_speed_last":{:.2f},"wind_dir_last":{},)"
                      R"("wind_speed_hi_last_10_min":{:.2f},"rain_size":1,"rain_rate_last":0}}]}})",
                      wind.speed(), wind.direction_deg, wind.gust()),
          wind_of(wind.speed() * kMetresPerSecondPerMph, wind.direction_deg, wind.gust() * kMetresPerSecondPerMph)};
}
JsonWinds weatherlink_live_winds(std::string_view bytes) {
  const auto conditions = drivers::decode::davis::decode_live_conditions(bytes, 0);
  return conditions ? JsonWinds{conditions->wind} : JsonWinds();
}

Message make_canboat(Chance& chance) {
  const JsonWind wind(chance);
  return {fmt::format(R"({{"timestamp":"2020-06-05-18:03:25.626","prio":2,"src":105,"dst":255,"pgn":130306,)"
                      R"("description":"Wind Data","fields":{{"SID":0,"Wind Speed":{:.2f},"Wind Angle":{}.0,)"
                      R"("Reference":"Apparent"}}}})",
                      wind.speed(), wind.direction_deg),
          wind_of(wind.speed(), wind.direction_deg)};
}
JsonWinds canboat_winds(std::string_view bytes) {
  using drivers::decode::marine::AngleUnit;
  const auto said = drivers::decode::marine::decode_canboat({.angle_unit = AngleUnit::kDegrees}, bytes);
  return said ? JsonWinds{said->wind} : JsonWinds();
}

Message make_signalk(Chance& chance) {
  const JsonWind wind(chance);
  const int angle_mrad = chance.between(0, 6282);
  return {fmt::format(R"({{"context":"vessels.self","updates":[{{"$source":"n2k.105",)"
                      R"("timestamp":"2026-06-21T15:09:17.012Z","values":[)"
                      R"({{"path":"environment.wind.speedApparent","value":{:.2f}}},)"
                      R"({{"path":"environment.wind.angleApparent","value":{:.3f}}}]}}]}})",
                      wind.speed(), angle_mrad / 1000.0),
          wind_of(wind.speed(), angle_mrad / 1000.0 / kRadPerDeg)};
}
JsonWinds signalk_winds_in(std::string_view bytes) {
  const auto delta = drivers::decode::marine::decode_signalk(bytes);
  if (!delta) return {};
  JsonWinds winds;
  for (const auto& update : delta->updates) {
    for (const auto& wind : drivers::decode::marine::signalk_winds(update.values)) {
      if (wind) winds.push_back(wind->wind);
    }
  }
  return winds;
}

Message make_json_line(Chance& chance) {
  const JsonWind wind(chance);
  return {fmt::format(R"({{"wind":{{"speed":{:.1f},"direction":{},"gust":{:.1f}}}}})", wind.speed(), wind.direction_deg,
                      wind.gust()),
          wind_of(wind.speed(), wind.direction_deg, wind.gust())};
}
JsonWinds json_line_winds(std::string_view bytes) {
  static const drivers::decode::text::LineOptions options = [] {
    drivers::decode::text::LineOptions made;
    made.speed.key = "/wind/speed";
    made.direction.key = "/wind/direction";
    made.gust.key = "/wind/gust";
    return made;
  }();
  const auto wind = drivers::decode::text::decode_line(options, bytes);
  return wind ? JsonWinds{*wind} : JsonWinds();
}

JsonWinds json_answer_winds(std::string_view bytes) {
  const auto answer = drivers::decode::network::decode_json_wind(
      bytes, {.speed = "/wind/speed", .direction = "/wind/direction", .gust = "/wind/gust"});
  return answer ? JsonWinds{answer->wind} : JsonWinds();
}

/// The number there, as the MQTT driver takes it: none where it cannot be read.
std::optional<double> mqtt_number(const drivers::mqtt::Payload& payload, const std::string& pointer) {
  const auto number = payload.number_at(pointer);
  return number ? *number : std::nullopt;
}

/// As the MQTT driver makes a wind of numbers: an impossible direction is none.
JsonWinds mqtt_wind(std::optional<double> speed_m_s, std::optional<double> direction_deg) {
  if (!speed_m_s) return {};
  DecodedWind wind = wind_of(speed_m_s);
  if (direction_deg) wind.direction_deg = drivers::decode::wrapped_direction_deg(*direction_deg);
  const auto sound = checked(wind);
  return sound ? JsonWinds{*sound} : JsonWinds();
}
JsonWinds mqtt_json_winds(std::string_view bytes) {
  const drivers::mqtt::Payload payload(bytes);
  return mqtt_wind(mqtt_number(payload, "/wind/speed"), mqtt_number(payload, "/wind/direction"));
}
Message make_mqtt_number(Chance& chance) {
  const JsonWind wind(chance);
  return {fmt::format("{:.1f}", wind.speed()), wind_of(wind.speed())};
}
JsonWinds mqtt_number_winds(std::string_view bytes) {
  return mqtt_wind(mqtt_number(drivers::mqtt::Payload(bytes, drivers::mqtt::PayloadForm::kText), ""), {});
}
Message make_mqtt_json(Chance& chance) {
  Message message = make_json_line(chance);
  message.wind.gust_m_s.reset();
  return message;
}

constexpr std::array kJsonProtocols = {
    Protocol{.name = "Tempest observation",
             .most_false_of_a_million = 14'000,
             .make = make_tempest,
             .winds_in = tempest_winds},
    Protocol{.name = "Tempest rapid wind",
             .most_false_of_a_million = 14'000,
             .make = make_rapid_wind,
             .winds_in = tempest_winds},
    Protocol{.name = "WeatherLink Live",
             .most_false_of_a_million = 29'000,
             .make = make_weatherlink_live,
             .winds_in = weatherlink_live_winds},
    Protocol{.name = "canboat", .most_false_of_a_million = 37'000, .make = make_canboat, .winds_in = canboat_winds},
    Protocol{.name = "Signal K", .most_false_of_a_million = 32'000, .make = make_signalk, .winds_in = signalk_winds_in},
    Protocol{
        .name = "line, JSON", .most_false_of_a_million = 73'000, .make = make_json_line, .winds_in = json_line_winds},
    Protocol{.name = "JSON by HTTP",
             .most_false_of_a_million = 73'000,
             .make = make_json_line,
             .winds_in = json_answer_winds},
    Protocol{
        .name = "MQTT, JSON", .most_false_of_a_million = 49'000, .make = make_mqtt_json, .winds_in = mqtt_json_winds},
    Protocol{.name = "MQTT, a number",
             .most_false_of_a_million = 320'000,
             .make = make_mqtt_number,
             .winds_in = mqtt_number_winds},
};

}  // namespace

std::span<const Protocol> json_protocols() {
  return kJsonProtocols;
}

}  // namespace yuragi::hurt
