#include "daemon/settings/feeds/osc.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "engine/base/address.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings::feeds {
namespace {

constexpr double kMaxRate_hz = 240.0;
constexpr double kDay_s = 86'400.0;
constexpr double kUsualAbove_m_s = 10.0, kUsualCalm_m_s = 1.0;
constexpr std::size_t kMaxAddress = 255;

std::vector<std::string> words_of(std::string_view text) {
  std::istringstream in{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

Result<std::string, Failure> checked_target(const std::string& text) {
  const auto target = parse_address(text);
  if (!target) return target.error();
  if (target->port == 0) return Failure{"has port 0; give the port on which the receiver listens"};
  return {boost::system::in_place_value, text};
}

Result<std::string, Failure> checked_parts(const std::string& text) {
  const std::vector<std::string> words = words_of(text);
  const bool are_parts =
      std::ranges::all_of(words, [](const auto& word) { return std::ranges::count(kOscParts, word) == 1; });
  if (text == kOscMappedOnly || (!words.empty() && are_parts)) return {boost::system::in_place_value, text};
  return Failure{
      fmt::format("is \"{}\"; allowed: some of {}, or {} alone", text, fmt::join(kOscParts, ", "), kOscMappedOnly)};
}

/// OSC's addresses are printable ASCII without blanks and the characters of patterns (OSC 1.0).
bool is_osc_path(std::string_view text) {
  return text.starts_with('/') && text.size() <= kMaxAddress && std::ranges::all_of(text, [](char c) {
           return c > ' ' && c < 0x7F && std::string_view("#*,?[]{}").find(c) == std::string_view::npos;
         });
}

Result<std::string, Failure> checked_path(const std::string& text) {
  if (is_osc_path(text)) return {boost::system::in_place_value, text};
  return Failure{fmt::format("is \"{}\"; an OSC address begins with / and has no blanks and none of #*,?[]{{}}", text)};
}

Result<std::string, Failure> checked_prefix(const std::string& text) {
  if (text.empty()) return {boost::system::in_place_value, text};
  return checked_path(text);
}

const Fields<Osc>& osc_fields() {
  static const Fields<Osc> kFields{
      {{.name = "to",
        .default_value = std::string("127.0.0.1:9000"),
        .help =
            "HOST:PORT of the receiver; a broadcast address (192.168.1.255) or a multicast address reaches several"},
       &Osc::to,
       checked_target},
      {{.name = "rate",
        .unit = "Hz",
        .default_value = 60.0,
        .min = 1.0,
        .max = kMaxRate_hz,
        .help = "how often the wind is sent, at most once a tick",
        .left_out = "at each tick"},
       &Osc::rate_hz},
      {{.name = "send",
        .default_value = std::string("wind sensors places scenes"),
        .help = "which messages: some of wind, sensors, places, scenes; or mapped: only [[osc.map]] and [[osc.cue]]"},
       &Osc::send,
       checked_parts},
      {{.name = "prefix",
        .default_value = std::string(),
        .help = "stands before all addresses except those of [[osc.map]] and [[osc.cue]]: /yuragi"},
       &Osc::prefix,
       checked_prefix},
      {{.name = "bundle",
        .default_value = true,
        .help = "the messages of a tick are sent as one bundle; false: each as a datagram of its own"},
       &Osc::bundles},
      {{.name = "time_tags",
        .default_value = false,
        .help = "bundles carry the time of the tick. Some receivers hold a bundle until that time: use it only if the "
                "clocks of both machines agree"},
       &Osc::time_tags},
      {{.name = "wind",
        .default_value = std::string(values::kWindNames[0]),
        .help = "shaped: the wind that moves the scenes; real: the measured wind, for another daemon that shapes it "
                "itself",
        .choices = values::kWindNames},
       &Osc::wind},
  };
  return kFields;
}

const Fields<OscMap>& osc_map_fields() {
  static const Fields<OscMap> kFields{
      {{.name = "value",
        .default_value = std::string("gust_norm"),
        .help = "what is sent: speed, direction, u, v, mean, gust, peak, norm, gust_norm, live, age, sensor:NAME, "
                "place:NAME, scene:NAME, or a part of one: place:NAME.gust_norm"},
       &OscMap::value_text},
      {{.name = "address",
        .default_value = std::string("/value"),
        .help = "the receiver's address: /composition/layers/1/video/opacity"},
       &OscMap::address,
       checked_path},
      {{.name = "from",
        .default_value = std::string("0 1"),
        .help = "two numbers: the range of the value that becomes the range `to`",
        .left_out = "the value's usual range"},
       &OscMap::given_from,
       span_of},
      {{.name = "to",
        .default_value = std::string("0 1"),
        .help = "two numbers: the range that the receiver gets; values beyond it are limited"},
       &OscMap::to,
       span_of},
      {{.name = "curve",
        .default_value = 1.0,
        .min = 0.1,
        .max = 10.0,
        .help = "exponent of the way from one end to the other: above 1, weak wind does less"},
       &OscMap::curve},
      {{.name = "smooth",
        .unit = "s",
        .default_value = 0.0,
        .min = 0.0,
        .max = 60.0,
        .help = "time constant of a low pass"},
       &OscMap::smooth_s},
  };
  return kFields;
}

const Fields<OscCue>& osc_cue_fields() {
  static const Fields<OscCue> kFields{
      {{.name = "when",
        .default_value = std::string(kOscConditionNames[0]),
        .help = "gust: the speed rises by `rise` within 2 s; wind_above: it exceeds `speed`; calm: it is below "
                "`speed` for `after`; sensor_silent: the readings of `sensor` are not used for `after`",
        .choices = kOscConditionNames},
       &OscCue::when},
      {{.name = "rise", .unit = "m/s", .default_value = 3.0, .min = 0.1, .max = 50.0, .help = "for gust"},
       &OscCue::rise_m_s},
      {{.name = "speed",
        .unit = "m/s",
        .default_value = kUsualAbove_m_s,
        .min = 0.1,
        .max = 100.0,
        .help = "for wind_above, calm",
        .left_out = "10 m/s; for calm 1 m/s"},
       &OscCue::speed_m_s},
      {{.name = "after",
        .unit = "s",
        .default_value = 0.0,
        .min = 0.0,
        .max = kDay_s,
        .help = "how long the condition has to hold; for all but gust",
        .left_out = "0 s; for sensor_silent 5 s"},
       &OscCue::after_s},
      {{.name = "sensor",
        .default_value = std::string(),
        .help = "for sensor_silent: the name of the sensor; empty: any"},
       &OscCue::sensor},
      {{.name = "again_after",
        .unit = "s",
        .default_value = 20.0,
        .min = 0.0,
        .max = kDay_s,
        .help = "shortest time between two messages of this cue"},
       &OscCue::again_after_s},
      {{.name = "address", .default_value = std::string("/cue/go"), .help = "the receiver's address: /cue/12/start"},
       &OscCue::address,
       checked_path},
  };
  return kFields;
}

}  // namespace

double OscCue::limit_m_s() const {
  return speed_m_s.value_or(when == OscCondition::kCalm ? kUsualCalm_m_s : kUsualAbove_m_s);
}

double OscCue::holds_for_s() const {
  constexpr double kUsualSilence_s = 5.0;
  return after_s.value_or(when == OscCondition::kSensorSilent ? kUsualSilence_s : 0.0);
}

bool Osc::sends(std::string_view part) const {
  return std::ranges::count(words_of(send), part) > 0;
}

std::span<const Parameter> osc_parameters() {
  return osc_fields().parameters();
}
std::span<const Parameter> osc_map_parameters() {
  return osc_map_fields().parameters();
}
std::span<const Parameter> osc_cue_parameters() {
  return osc_cue_fields().parameters();
}

Result<Osc, ParameterError> osc_of(std::string name, const ParameterValues& values) {
  auto osc = made_of(osc_fields(), values);
  if (osc) osc->name = std::move(name);
  return osc;
}

Result<OscMap, ParameterError> osc_map_of(const ParameterValues& values, const values::Names& names) {
  auto map = made_of(osc_map_fields(), values);
  if (!map) return map;
  auto value = value_named(map->value_text, names);
  if (!value) return value.error();
  map->from = map->given_from.value_or(range_of(value->description()));
  map->value = std::move(*value);
  return map;
}

Result<OscCue, ParameterError> osc_cue_of(const ParameterValues& values, const values::Names& names) {
  auto cue = made_of(osc_cue_fields(), values);
  if (!cue || cue->sensor.empty()) return cue;
  if (cue->when != OscCondition::kSensorSilent)
    return ParameterError{"sensor", "applies only if when = \"sensor_silent\"; remove it"};
  if (!values::index_of(names.sensors, cue->sensor))
    return ParameterError{"sensor", "is \"" + cue->sensor + "\"; allowed: the name of a [[sensor]] of this file"};
  return cue;
}

}  // namespace yuragi::daemon::settings::feeds
