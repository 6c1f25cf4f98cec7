#include "drivers/modbus/modbus_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <toml++/toml.h>

#include "engine/base/printable_text.hpp"
#include "engine/tables/parse_toml.hpp"

namespace yuragi::drivers::modbus {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Takes values out of one table of the file, checks them, and records which keys were taken.
class TableReader {
 public:
  TableReader(const toml::table& table, std::string path, std::string_view file)
      : table_(table), path_(std::move(path)), file_(file) {}

  [[noreturn]] void fail(std::string_view key, const std::string& what) const {
    const toml::node* node = table_.get(key);
    const toml::source_position at = (node != nullptr ? *node : table_).source().begin;
    std::ostringstream out;
    out << file_ << ':' << std::max(at.line, 1U) << ':' << std::max(at.column, 1U) << ": " << path_ << key << ": "
        << what;
    std::string text = out.str();
    make_printable(text);
    throw std::runtime_error(text);
  }

  bool has(std::string_view key) const { return table_.contains(key); }

  std::string text(std::string_view key, std::optional<std::string> fallback = std::nullopt) {
    const toml::node* node = take(key, fallback.has_value(), "a text");
    if (node == nullptr) return *std::move(fallback);
    const auto* value = node->as_string();
    if (value == nullptr) fail(key, "is not a text; allowed: a text");
    if (!is_printable(value->get())) fail(key, "contains a control character; type it again");
    return value->get();
  }

  /// The index of the text in `choices`; `fallback` if it is absent.
  std::size_t choice(std::string_view key, std::span<const std::string_view> choices,
                     std::optional<std::string> fallback = std::nullopt) {
    std::string allowed = "one of";
    for (const std::string_view one : choices) allowed.append(" \"").append(one).append("\"");
    const toml::node* node = take(key, fallback.has_value(), allowed);
    const auto* value = node != nullptr ? node->as_string() : nullptr;
    if (node != nullptr && value == nullptr) fail(key, "is not a text; allowed: " + allowed);
    const std::string& given = value != nullptr ? value->get() : *fallback;
    const auto found = std::ranges::find(choices, given);
    if (found == choices.end()) fail(key, "is \"" + given + "\"; allowed: " + allowed);
    return static_cast<std::size_t>(found - choices.begin());
  }

  std::int64_t whole(std::string_view key, std::int64_t min, std::int64_t max,
                     std::optional<std::int64_t> fallback = std::nullopt) {
    const std::string allowed = "a whole number from " + std::to_string(min) + " to " + std::to_string(max);
    const toml::node* node = take(key, fallback.has_value(), allowed);
    if (node == nullptr) return *fallback;
    const auto* value = node->as_integer();
    if (value == nullptr) fail(key, "is not a whole number; allowed: " + allowed);
    if (value->get() < min || value->get() > max) {
      fail(key, "is " + std::to_string(value->get()) + "; allowed: " + allowed);
    }
    return value->get();
  }

  std::int64_t whole_among(std::string_view key, std::span<const std::int64_t> choices, std::int64_t fallback) {
    const std::int64_t value =
        whole(key, std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max(), fallback);
    if (std::ranges::find(choices, value) == choices.end()) {
      std::string allowed = "one of";
      for (const std::int64_t one : choices) allowed.append(" ").append(std::to_string(one));
      fail(key, "is " + std::to_string(value) + "; allowed: " + allowed);
    }
    return value;
  }

  /// A list of texts, each of which is one of `choices`: which they are.
  std::vector<std::size_t> choice_list(std::string_view key, std::span<const std::string_view> choices) {
    std::string allowed = "a list of";
    for (const std::string_view one : choices) allowed.append(" \"").append(one).append("\"");
    const toml::node* node = take(key, false, allowed);
    if (!node->is_array()) fail(key, "is not a list; allowed: " + allowed);
    std::vector<std::size_t> chosen;
    for (const toml::node& element : *node->as_array()) {
      const auto* value = element.as_string();
      const auto found = value != nullptr ? std::ranges::find(choices, value->get()) : choices.end();
      if (found == choices.end()) fail(key, "contains an entry that is not allowed; allowed: " + allowed);
      chosen.push_back(static_cast<std::size_t>(found - choices.begin()));
    }
    return chosen;
  }

  double number(std::string_view key, double min, double max, double fallback) {
    std::ostringstream allowed;
    allowed << "a finite number";
    if (std::isfinite(min)) allowed << " from " << min << " to " << max;
    const toml::node* node = take(key, true, allowed.str());
    if (node == nullptr) return fallback;
    const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value) fail(key, "is not a number; allowed: " + allowed.str());
    if (!std::isfinite(*value) || *value < min || *value > max) {
      std::ostringstream what;
      what << "is " << *value << "; allowed: " << allowed.str();
      fail(key, what.str());
    }
    return *value;
  }

  Nanoseconds duration(std::string_view key, double min_s, double max_s, Nanoseconds fallback) {
    return from_seconds(number(key, min_s, max_s, seconds(fallback)));
  }

  bool flag(std::string_view key, bool fallback) {
    const toml::node* node = take(key, true, "true or false");
    if (node == nullptr) return fallback;
    const auto* value = node->as_boolean();
    if (value == nullptr) fail(key, "is neither true nor false; allowed: true or false");
    return value->get();
  }

  std::vector<std::int64_t> wholes(std::string_view key, std::int64_t min, std::int64_t max) {
    const std::string allowed = "a list of whole numbers from " + std::to_string(min) + " to " + std::to_string(max);
    const toml::node* node = take(key, true, allowed);
    if (node == nullptr) return {};
    std::vector<std::int64_t> values;
    if (!node->is_array()) fail(key, "is not a list; allowed: " + allowed);
    for (const toml::node& element : *node->as_array()) {
      const auto* value = element.as_integer();
      if (value == nullptr || value->get() < min || value->get() > max) {
        fail(key, "contains an entry that is not allowed; allowed: " + allowed);
      }
      values.push_back(value->get());
    }
    return values;
  }

  /// The table named `key`; an empty one if it is absent and not required.
  TableReader table(std::string_view key, bool required) {
    static const toml::table kEmpty;
    const toml::node* node = take(key, !required, "a table [" + std::string(key) + "]");
    if (node != nullptr && !node->is_table()) fail(key, "is not a table; allowed: a table [" + std::string(key) + "]");
    return {node != nullptr ? *node->as_table() : kEmpty, path_ + std::string(key) + ".", file_};
  }

  /// Refuses keys that were not taken.
  void finish() const {
    for (const auto& [key, node] : table_) {
      if (taken_.contains(std::string(key.str()))) continue;
      std::string allowed;
      for (const std::string& one : taken_) allowed.append(allowed.empty() ? "" : ", ").append(one);
      fail(key.str(), "is not known here; allowed: " + allowed);
    }
  }

 private:
  const toml::node* take(std::string_view key, bool is_optional, const std::string& allowed) {
    taken_.emplace(key);
    const toml::node* node = table_.get(key);
    if (node == nullptr && !is_optional) fail(key, "is missing; allowed: " + allowed);
    return node;
  }

  const toml::table& table_;
  std::string path_;
  std::string_view file_;
  std::set<std::string> taken_;
};

/// The whole numbers that a type can hold; for f32 its bits.
std::pair<std::int64_t, std::int64_t> range_of(decode::modbus::RegisterType type) {
  switch (type) {
    case decode::modbus::RegisterType::kU16:
      return {0, 0xFFFF};
    case decode::modbus::RegisterType::kI16:
      return {-0x8000, 0x7FFF};
    case decode::modbus::RegisterType::kI32:
      return {-0x80000000LL, 0x7FFFFFFF};
    case decode::modbus::RegisterType::kU32:
    case decode::modbus::RegisterType::kF32:
      break;
  }
  return {0, 0xFFFFFFFFLL};
}

std::optional<double> optional_number(TableReader& reader, std::string_view key) {
  if (!reader.has(key)) return std::nullopt;
  return reader.number(key, -kInfinity, kInfinity, 0.0);
}

/// The common part of a speed and a direction. `address_base` is the first number in the maker's numbering.
decode::modbus::Quantity read_quantity(TableReader& reader, std::int64_t address_base) {
  decode::modbus::Quantity quantity;
  quantity.slave = static_cast<std::uint8_t>(reader.whole("slave", 1, 247));
  quantity.function = static_cast<std::uint8_t>(reader.whole("function", 3, 4, 3));
  quantity.type = static_cast<decode::modbus::RegisterType>(reader.choice("type", decode::modbus::kRegisterTypeNames));
  quantity.order =
      static_cast<decode::modbus::ByteOrder>(reader.choice("order", decode::modbus::kByteOrderNames, "ABCD"));
  const auto last = 0x10000 - static_cast<std::int64_t>(decode::modbus::register_count(quantity.type));
  const std::int64_t address = reader.whole("address", address_base, address_base + last);
  quantity.address = static_cast<std::uint16_t>(address - address_base);

  quantity.scale = reader.number("scale", -kInfinity, kInfinity, 1.0);
  if (quantity.scale == 0.0) reader.fail("scale", "is 0; allowed: a finite number other than 0");
  quantity.offset = reader.number("offset", -kInfinity, kInfinity, 0.0);
  const auto [lowest, highest] = range_of(quantity.type);
  quantity.invalid = reader.wholes("invalid", lowest, highest);
  quantity.min = optional_number(reader, "min");
  quantity.max = optional_number(reader, "max");
  if (quantity.min && quantity.max && *quantity.min > *quantity.max) {
    reader.fail("max", "is below min; allowed: min or more");
  }
  quantity.read_has_side_effect = reader.flag("read_has_side_effect", false);
  return quantity;
}

/// A speed, or a gust.
decode::modbus::Quantity read_speed(TableReader reader, std::int64_t address_base) {
  decode::modbus::Quantity speed = read_quantity(reader, address_base);
  // Every unit but the last is one of speed.
  speed.unit = static_cast<decode::modbus::QuantityUnit>(
      reader.choice("unit", std::span(decode::modbus::kQuantityUnitNames).first(4)));
  reader.finish();
  return speed;
}

/// Reads the meaning of the speed: three keys that belong together.
std::optional<sensor::StatedValue> read_value(TableReader& speed) {
  if (!speed.has("value")) {
    for (const char* key : {"averaging_s", "value_source"}) {
      if (speed.has(key)) speed.fail(key, "is set without value; allowed: only together with value");
    }
    return std::nullopt;
  }
  constexpr double kMaxAveraging_s = 3600.0;
  sensor::StatedValue stated;
  stated.value = static_cast<wind::ReadingValue>(speed.choice("value", wind::kReadingValueNames));
  stated.averaging_s = speed.number("averaging_s", 0.0, kMaxAveraging_s, 0.0);
  if (stated.value == wind::ReadingValue::kInstant && stated.averaging_s > 0.0) {
    speed.fail("averaging_s", "is above 0, but an instantaneous value has no averaging time; allowed: none");
  }
  stated.source = speed.text("value_source");
  if (stated.source.empty()) speed.fail("value_source", "is empty; allowed: the document that states the value");
  return stated;
}

decode::modbus::Quantity read_direction(TableReader reader, std::int64_t address_base) {
  decode::modbus::Quantity direction = read_quantity(reader, address_base);
  direction.unit = decode::modbus::QuantityUnit::kDegrees;
  reader.choice("unit", std::span(decode::modbus::kQuantityUnitNames).last(1), "deg");
  direction.map =
      static_cast<decode::modbus::DirectionMap>(reader.choice("map", decode::modbus::kDirectionMapNames, "degrees"));
  reader.finish();
  return direction;
}

/// Reads a number without a unit, or with the unit in its name.
decode::modbus::Quantity read_number(TableReader reader, std::int64_t address_base) {
  decode::modbus::Quantity quantity = read_quantity(reader, address_base);
  reader.finish();
  return quantity;
}

/// The tables [quantities.NAME].
void read_station_quantities(TableReader reader, std::int64_t address_base, Profile& profile) {
  for (const wind::StationQuantity& what : wind::kStationQuantities) {
    const bool is_there = reader.has(what.name);
    TableReader table = reader.table(what.name, false);
    if (is_there) profile.quantities.push_back({what, read_number(std::move(table), address_base)});
  }
  reader.finish();
}

void read_evidence(TableReader& reader, Profile& profile) {
  for (const std::size_t index : reader.choice_list("confirmed_by", kProfileEvidenceNames)) {
    profile.confirmed_by.push_back(static_cast<ProfileEvidence>(index));
  }
  profile.unconfirmed = reader.text("unconfirmed");
  if (profile.confirmed_by.empty() && profile.unconfirmed.empty()) {
    reader.fail("unconfirmed",
                "is empty, but confirmed_by is empty, too; allowed: a text that describes what is unconfirmed");
  }
}

void read_serial(TableReader reader, Profile& profile) {
  static constexpr std::string_view kParities[] = {"none", "even", "odd"};
  profile.baud = static_cast<int>(reader.whole_among("baud", kModbusBauds, profile.baud));
  profile.parity = "NEO"[reader.choice("parity", kParities, "none")];
  profile.stop_bits = static_cast<int>(reader.whole("stop_bits", 1, 2, profile.stop_bits));
  reader.finish();
}

void read_timing(TableReader reader, Profile& profile) {
  profile.poll_interval = reader.duration("poll_interval_s", 0.01, 3600.0, profile.poll_interval);
  profile.min_gap = reader.duration("min_gap_s", 0.0, 10.0, profile.min_gap);
  profile.response_timeout = reader.duration("response_timeout_s", 0.01, 10.0, profile.response_timeout);
  profile.byte_timeout = reader.duration("byte_timeout_s", 0.001, 1.0, profile.byte_timeout);
  profile.delay_after_open = reader.duration("delay_after_open_s", 0.0, 60.0, profile.delay_after_open);
  profile.warm_up = reader.duration("warm_up_s", 0.0, 600.0, profile.warm_up);
  profile.quantities_interval = reader.duration("quantities_interval_s", 1.0, 3600.0, profile.quantities_interval);
  reader.finish();
}

}  // namespace

Profile parse_modbus_profile(std::string_view text, std::string_view file) {
  toml::table root;
  try {
    root = tables::parse_toml(text, file);
  } catch (const toml::parse_error& error) {
    std::ostringstream out;
    out << file << ':' << error.source().begin.line << ':' << error.source().begin.column
        << ": not TOML: " << error.description();
    throw std::runtime_error(out.str());
  }

  TableReader reader(root, "", file);
  Profile profile;
  profile.name = reader.text("name");
  profile.source = reader.text("source");
  read_evidence(reader, profile);
  profile.revision = reader.text("revision", "");

  static constexpr std::string_view kSerialOrTcp[] = {"rtu", "tcp"};
  profile.is_serial = reader.choice("transport", kSerialOrTcp, "rtu") == 0;
  read_serial(reader.table("serial", false), profile);
  read_timing(reader.table("timing", false), profile);
  profile.block_read = reader.flag("block_read", true);
  profile.block_gap = static_cast<int>(reader.whole("block_gap", 0, 100, 0));
  profile.north_offset_deg = reader.number("north_offset_deg", -360.0, 360.0, 0.0);

  // Numbered from 0 as on the wire, from 1, or with the table's digit in front. A maker's 30001 that is sent unchanged
  // has base 0.
  static constexpr std::int64_t kBases[] = {0, 1, 30001, 40001};
  const std::int64_t address_base = reader.whole_among("address_base", kBases, 0);
  TableReader speed = reader.table("speed", true);
  profile.value = read_value(speed);
  profile.speed = read_speed(std::move(speed), address_base);
  const bool has_direction = reader.has("direction");
  TableReader direction = reader.table("direction", false);
  if (has_direction) profile.direction = read_direction(std::move(direction), address_base);
  const bool has_gust = reader.has("gust");
  TableReader gust = reader.table("gust", false);
  if (has_gust) profile.gust = read_speed(std::move(gust), address_base);
  const bool has_beaufort = reader.has("beaufort");
  TableReader beaufort = reader.table("beaufort", false);
  if (has_beaufort) profile.beaufort = read_number(std::move(beaufort), address_base);
  read_station_quantities(reader.table("quantities", false), address_base, profile);
  reader.finish();
  return profile;
}

void set_slave(Profile& profile, std::uint8_t id) {
  const std::uint8_t before = std::exchange(profile.speed.slave, id);
  if (profile.direction && profile.direction->slave == before) profile.direction->slave = id;
  if (profile.gust && profile.gust->slave == before) profile.gust->slave = id;
  if (profile.beaufort && profile.beaufort->slave == before) profile.beaufort->slave = id;
  for (StationQuantity& station : profile.quantities) {
    if (station.quantity.slave == before) station.quantity.slave = id;
  }
}

}  // namespace yuragi::drivers::modbus
