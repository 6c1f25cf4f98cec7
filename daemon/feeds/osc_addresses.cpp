#include "daemon/feeds/osc_addresses.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "drivers/bus/osc_message.hpp"
#include "engine/wind/judging/sensor_state.hpp"

namespace yuragi::daemon::feeds {
namespace {

using values::Moment;
using values::Quantity;
using values::Wind;

bool is_kept(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// A further byte of a character of UTF-8.
bool is_continuation(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

OscArguments numbers_of(std::initializer_list<double> values) {
  std::vector<float> floats;
  for (const double value : values) floats.push_back(static_cast<float>(value));
  return floats;
}

OscNumber number_of(Quantity quantity) {
  const values::QuantityDescription& description = values::description_of(quantity);
  return {description.unit, description.min, description.max};
}

/// Finds the wind that an address is about; null: it is not there.
using FindReadout = std::function<const values::Readout*(const Moment& moment, Wind wind)>;

/// First speed and direction together, then each value by itself. `where`: "at the place door".
void add_readout(std::vector<OscAddress>& all, std::string_view part, const std::string& path, const std::string& where,
                 const FindReadout& find) {
  all.push_back({.part = part,
                 .path = path,
                 .help = fmt::format("speed and direction of the wind{}", where),
                 .numbers = {number_of(Quantity::kSpeed), number_of(Quantity::kDirection)},
                 .read = [find](const Moment& moment, Wind wind) -> std::optional<OscArguments> {
                   const values::Readout* const readout = find(moment, wind);
                   if (readout == nullptr) return std::nullopt;
                   return numbers_of({(*readout)[Quantity::kSpeed], (*readout)[Quantity::kDirection]});
                 }});
  for (std::size_t i = 0; i < values::kQuantityCount; ++i) {
    const auto quantity = static_cast<Quantity>(i);
    const values::QuantityDescription& description = values::description_of(quantity);
    all.push_back({.part = part,
                   .path = fmt::format("{}/{}", path, description.name),
                   .help = fmt::format("{}{}", description.help, where),
                   .numbers = {number_of(quantity)},
                   .read = [find, quantity](const Moment& moment, Wind wind) -> std::optional<OscArguments> {
                     const values::Readout* const readout = find(moment, wind);
                     if (readout == nullptr) return std::nullopt;
                     return numbers_of({(*readout)[quantity]});
                   }});
  }
}

void add_sensor(std::vector<OscAddress>& all, std::size_t index, const std::string& part, const std::string& name) {
  const auto add = [&](std::string_view value, std::string_view help, const OscNumber& number,
                       double values::SensorValue::*member) {
    all.push_back({.part = "sensors",
                   .pace = OscPace::kTenTimesASecond,
                   .path = fmt::format("/sensor/{}/{}", part, value),
                   .help = fmt::format("{} of the sensor {}", help, name),
                   .numbers = {number},
                   .read = [index, member](const Moment& moment, Wind) -> std::optional<OscArguments> {
                     if (index >= moment.sensors.size()) return std::nullopt;
                     const double sent = moment.sensors[index].*member;
                     return std::isfinite(sent) ? std::optional(numbers_of({sent})) : std::nullopt;
                   }});
  };
  add("speed", "the last speed", number_of(Quantity::kSpeed), &values::SensorValue::speed_m_s);
  add("direction", "the last direction", number_of(Quantity::kDirection), &values::SensorValue::direction_deg);
  add("age", "the time since the last reading", number_of(Quantity::kAge), &values::SensorValue::age_s);
  all.push_back({.part = "sensors",
                 .pace = OscPace::kOnChange,
                 .path = fmt::format("/sensor/{}/state", part),
                 .help = fmt::format("the state of the sensor {}", name),
                 .texts = {wind::judging::kSensorStateNames.begin(), wind::judging::kSensorStateNames.end()},
                 .read = [index](const Moment& moment, Wind) -> std::optional<OscArguments> {
                   if (index >= moment.sensors.size()) return std::nullopt;
                   return std::string(wind::judging::name_of(moment.sensors[index].state));
                 }});
}

void add_scene(std::vector<OscAddress>& all, std::size_t index, const std::string& part, const std::string& name) {
  all.push_back({.part = "scenes",
                 .pace = OscPace::kOnChange,
                 .path = fmt::format("/scene/{}/opacity", part),
                 .help = fmt::format("how visible the scene {} is", name),
                 .numbers = {{"", 0.0, 1.0}},
                 .read = [index](const Moment& moment, Wind) -> std::optional<OscArguments> {
                   if (index >= moment.opacities.size()) return std::nullopt;
                   return numbers_of({moment.opacities[index]});
                 }});
}

}  // namespace

std::optional<std::vector<std::uint8_t>> OscAddress::message(const Moment& moment, Wind wind,
                                                             const std::string& prefix) const {
  const std::optional<OscArguments> arguments = read(moment, wind);
  if (!arguments) return std::nullopt;
  return std::visit([&](const auto& given) { return drivers::bus::encode_osc(prefix + path, given); }, *arguments);
}

std::vector<OscAddress> osc_addresses_of(const values::Names& names) {
  std::vector<OscAddress> all;
  add_readout(all, "wind", "/wind", "", [](const Moment& moment, Wind wind) { return &moment.wind(wind); });
  all.push_back({.part = "wind",
                 .pace = OscPace::kOnChange,
                 .path = "/wind/state",
                 .help = "where the wind comes from: live: sensors; default: none of them, it is synthetic",
                 .texts = {values::name_of(wind::Source::kLive), values::name_of(wind::Source::kHandover),
                           values::name_of(wind::Source::kDefault)},
                 .read = [](const Moment& moment, Wind) -> std::optional<OscArguments> {
                   return std::string(values::name_of(moment.source));
                 }});
  const std::vector<std::string> sensors = osc_parts_of(names.sensors);
  for (std::size_t i = 0; i < sensors.size(); ++i) add_sensor(all, i, sensors[i], names.sensors[i]);
  const std::vector<std::string> places = osc_parts_of(names.places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    add_readout(all, "places", "/place/" + places[i], fmt::format(" at the place {}", names.places[i]),
                [i](const Moment& moment, Wind wind) -> const values::Readout* {
                  const auto readouts = moment.places(wind);
                  return i < readouts.size() ? &readouts[i] : nullptr;
                });
  }
  const std::vector<std::string> scenes = osc_parts_of(names.scenes);
  for (std::size_t i = 0; i < scenes.size(); ++i) add_scene(all, i, scenes[i], names.scenes[i]);
  return all;
}

std::string osc_part_of(std::string_view name) {
  std::string part;
  for (const char c : name) {
    if (!is_continuation(c)) part += is_kept(c) ? c : '_';
  }
  return part;
}

std::vector<std::string> osc_parts_of(const std::vector<std::string>& names) {
  std::vector<std::string> parts;
  for (const std::string& name : names) {
    const std::string plain = osc_part_of(name);
    std::string part = plain;
    for (int number = 2; std::ranges::count(parts, part) > 0; ++number) part = fmt::format("{}_{}", plain, number);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace yuragi::daemon::feeds
