#include "daemon/values/reference.hpp"

#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

namespace yuragi::daemon::values {
namespace {

std::string quantity_names() {
  std::string names;
  for (const QuantityDescription& quantity : quantities()) {
    names.append(names.empty() ? "" : ", ").append(quantity.name);
  }
  return names;
}

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string listed(std::span<const std::string> names) {
  if (names.empty()) return "there is none";
  std::string all = "there are: ";
  for (std::size_t i = 0; i < names.size(); ++i) all.append(i == 0 ? "" : ", ").append(names[i]);
  return all;
}

}  // namespace

Result<Reference, Failure> Reference::parse(std::string_view text) {
  Reference reference;
  reference.text_ = std::string(text);
  std::string_view part = text;
  if (const std::size_t colon = text.find(':'); colon != std::string_view::npos) {
    const std::string_view owner = text.substr(0, colon);
    const std::string_view rest = text.substr(colon + 1);
    if (owner == "sensor") {
      reference.owner_ = Owner::kSensor;
    } else if (owner == "place") {
      reference.owner_ = Owner::kPlace;
    } else if (owner == "scene") {
      reference.owner_ = Owner::kScene;
    } else {
      return Failure{fmt::format("\"{}\" is not known before a colon; allowed: sensor, place, scene", owner)};
    }
    // A name may have dots: only a known quantity behind the last one is a part.
    const std::size_t dot = rest.rfind('.');
    const bool has_part = reference.owner_ != Owner::kScene && dot != std::string_view::npos &&
                          quantity_named(rest.substr(dot + 1)).has_value();
    reference.name_ = std::string(rest.substr(0, has_part ? dot : rest.size()));
    part = has_part ? rest.substr(dot + 1) : "speed";
    if (reference.name_.empty()) return Failure{fmt::format("\"{}\" has no name behind the colon", text)};
  }
  const std::optional<Quantity> quantity = quantity_named(part);
  if (!quantity)
    return Failure{
        fmt::format("\"{}\" is not a value; allowed: {}, sensor:NAME, place:NAME, scene:NAME, or a "
                    "part of one of these (place:NAME.gust)",
                    text, quantity_names())};
  reference.quantity_ = *quantity;
  const bool is_of_sensor =
      *quantity == Quantity::kSpeed || *quantity == Quantity::kDirection || *quantity == Quantity::kAge;
  if (reference.owner_ == Owner::kSensor && !is_of_sensor)
    return Failure{fmt::format("a sensor has no \"{}\"; allowed: speed, direction, age", part)};
  return reference;
}

std::optional<std::string> Reference::missing_in(const Names& names) const {
  const auto missing = [this](std::string_view what, std::span<const std::string> all) -> std::optional<std::string> {
    if (index_of(all, name_)) return std::nullopt;
    return fmt::format("there is no {} \"{}\"; {}", what, name_, listed(all));
  };
  switch (owner_) {
    case Owner::kSensor:
      return missing("sensor", names.sensors);
    case Owner::kPlace:
      return missing("place", names.places);
    case Owner::kScene:
      return missing("scene", names.scenes);
    case Owner::kWind:
      break;
  }
  return std::nullopt;
}

std::optional<double> Reference::value_in(const Moment& moment, Wind wind) const {
  switch (owner_) {
    case Owner::kWind:
      return moment.wind(wind)[quantity_];
    case Owner::kSensor: {
      const auto index = index_of(moment.names->sensors, name_);
      if (!index || *index >= moment.sensors.size()) return std::nullopt;
      const SensorValue& sensor = moment.sensors[*index];
      if (quantity_ == Quantity::kDirection) return finite(sensor.direction_deg);
      return finite(quantity_ == Quantity::kAge ? sensor.age_s : sensor.speed_m_s);
    }
    case Owner::kPlace: {
      const auto index = index_of(moment.names->places, name_);
      const std::span<const Readout> places = moment.places(wind);
      if (!index || *index >= places.size()) return std::nullopt;
      return places[*index][quantity_];
    }
    case Owner::kScene: {
      const auto index = index_of(moment.names->scenes, name_);
      if (!index || *index >= moment.opacities.size()) return std::nullopt;
      return moment.opacities[*index];
    }
  }
  return std::nullopt;
}

QuantityDescription Reference::description() const {
  if (owner_ != Owner::kScene) return description_of(quantity_);
  return {"opacity", "", 0.0, 1.0, "how visible a scene is"};
}

}  // namespace yuragi::daemon::values
