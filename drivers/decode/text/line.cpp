#include "drivers/decode/text/line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>

#include <nlohmann/json.hpp>

#include "drivers/decode/speed_units.hpp"

namespace yuragi::drivers::decode::text {
namespace {

using LineValue = Result<std::optional<double>, Refusal>;

/// A value's text, and the unit after it.
struct LineText {
  std::string_view number;
  std::string_view unit;
};
struct LineTexts {
  LineText speed;
  LineText direction;
  LineText gust;
};

constexpr std::array<std::string_view, 3> kDegreeWords = {"deg", "degrees", "\xC2\xB0"};

/// Returns the size of the unit with that name for that quantity; nullopt if it is not a unit.
std::optional<double> unit_named(std::string_view word, bool is_direction) {
  if (is_direction)
    return std::ranges::find(kDegreeWords, word) != kDegreeWords.end() ? std::optional(1.0) : std::nullopt;
  const auto unit = speed_unit_of_word(word);
  return unit ? std::optional(unit->metres_per_second) : std::nullopt;
}

bool is_unit(std::string_view word) {
  return unit_named(word, false) || unit_named(word, true);
}

bool is_missing_value(std::string_view text) {
  return text.empty() || text == "nan" || text == "NaN" || text == "NAN" || text == "null";
}

/// "4.2" or "4.2 km/h", in which the unit need not be known.
LineText with_unit(std::string_view text) {
  text = trimmed(text);
  const std::size_t end = std::min(text.find_first_not_of("+-.0123456789"), text.size());
  return end > 0 ? LineText{text.substr(0, end), trimmed(text.substr(end))} : LineText{text, {}};
}

/// Returns the value of a number in the quantity's unit, or in `unit` if the line has one.
LineValue scaled(const LineOptions& options, const LineQuantity& quantity, double number, std::optional<double> unit) {
  if (number == options.invalid) return std::optional<double>();
  const double value = (number * quantity.scale + quantity.offset) * unit.value_or(quantity.unit);
  if (!std::isfinite(value)) return Refusal::kImplausible;
  return std::optional(value);
}

LineValue value_of(const LineOptions& options, const LineQuantity& quantity, const LineText& text, bool is_direction) {
  if (is_missing_value(text.number)) return std::optional<double>();
  const auto number = parse_number(text.number);
  if (!number) return number.error();
  const std::optional<double> unit = unit_named(text.unit, is_direction);
  if (!text.unit.empty() && !unit) return Refusal::kMalformed;
  return scaled(options, quantity, **number, unit);
}

/// The next piece of `rest` between separators; empty at the end.
std::string_view next_piece(std::string_view& rest, std::string_view separators) {
  const std::size_t start = rest.find_first_not_of(separators);
  if (start == std::string_view::npos) {
    rest = {};
    return {};
  }
  rest.remove_prefix(start);
  const std::string_view piece = rest.substr(0, rest.find_first_of(separators));
  rest.remove_prefix(piece.size());
  return piece;
}

Result<LineTexts, Refusal> texts_of_columns(const LineOptions& options, std::string_view line) {
  TextFields fields;
  if (options.separator == ' ') {
    for (std::string_view piece; !(piece = next_piece(line, " \t")).empty();) {
      if (fields.count == kMaxTextFields) return Refusal::kMalformed;
      fields.values[fields.count++] = piece;
    }
  } else {
    fields = split_fields(line, options.separator);
  }
  if (!fields.are_all) return Refusal::kMalformed;

  const auto column = [&](const LineQuantity& quantity) {
    return with_unit(quantity.column ? fields[*quantity.column] : std::string_view());
  };
  return LineTexts{column(options.speed), column(options.direction), column(options.gust)};
}

Result<LineTexts, Refusal> texts_of_keys(const LineOptions& options, std::string_view line) {
  LineTexts texts;
  bool has_speed = false;
  bool has_direction = false;
  bool has_gust = false;
  for (std::string_view piece; !(piece = next_piece(line, " \t,;&")).empty();) {
    const std::size_t equals = piece.find_first_of("=:");
    const std::string_view key = piece.substr(0, equals);
    std::string_view text = equals == std::string_view::npos ? std::string_view() : piece.substr(equals + 1);
    // "speed: 4.2": the number is the next piece.
    if (equals != std::string_view::npos && text.empty() && !line.empty() && line.front() == ' ') {
      std::string_view ahead = line;
      const std::string_view next = next_piece(ahead, " \t");
      if (next.find_first_of("=:") == std::string_view::npos) text = next_piece(line, " \t,;&");
    }

    LineText value = with_unit(text);
    if (value.unit.empty() && !value.number.empty()) {  // "4.2 km/h"
      std::string_view ahead = line;
      const std::string_view word = next_piece(ahead, " \t");
      const std::string_view unit = word.substr(0, word.find_first_of(",;&"));
      if (is_unit(unit)) {
        value.unit = unit;
        line.remove_prefix(static_cast<std::size_t>(unit.data() + unit.size() - line.data()));
      }
    }

    const auto take = [&](const LineQuantity& quantity, LineText& into, bool& has) {
      if (quantity.key.empty() || key != quantity.key) return true;
      if (has) return false;
      has = true;
      into = value;
      return true;
    };
    const bool is_first_of_its_key = take(options.speed, texts.speed, has_speed) &&
                                     take(options.direction, texts.direction, has_direction) &&
                                     take(options.gust, texts.gust, has_gust);
    if (!is_first_of_its_key) return Refusal::kMalformed;
  }
  if (!has_speed && !has_direction && !has_gust) return Refusal::kNotMine;
  return texts;
}

/// The three values, in m/s and degrees.
struct LineValues {
  std::optional<double> speed_m_s;
  std::optional<double> direction_deg;
  std::optional<double> gust_m_s;
};

Result<LineValues, Refusal> values_of_texts(const LineOptions& options, const LineTexts& texts) {
  const LineValue speed_m_s = value_of(options, options.speed, texts.speed, false);
  if (!speed_m_s) return speed_m_s.error();
  const LineValue direction_deg = value_of(options, options.direction, texts.direction, true);
  if (!direction_deg) return direction_deg.error();
  const LineValue gust_m_s = value_of(options, options.gust, texts.gust, false);
  if (!gust_m_s) return gust_m_s.error();
  return LineValues{*speed_m_s, *direction_deg, *gust_m_s};
}

/// The value in a JSON object at a key, or at a JSON pointer; nullptr if it does not exist.
const nlohmann::json* find_in(const nlohmann::json& object, const std::string& key) {
  if (!key.starts_with('/')) return object.contains(key) ? &object[key] : nullptr;
  const nlohmann::json::json_pointer pointer(key);
  return object.contains(pointer) ? &object[pointer] : nullptr;
}

Result<LineValues, Refusal> values_of_json(const LineOptions& options, std::string_view line) {
  const nlohmann::json object = nlohmann::json::parse(line, nullptr, false);
  if (!object.is_object()) return Refusal::kMalformed;
  bool has_any = false;
  const auto value_at = [&](const LineQuantity& quantity, bool is_direction) -> LineValue {
    const nlohmann::json* found = quantity.key.empty() ? nullptr : find_in(object, quantity.key);
    if (found == nullptr) return std::optional<double>();
    has_any = true;
    if (found->is_null()) return std::optional<double>();
    if (found->is_number()) return scaled(options, quantity, found->get<double>(), std::nullopt);
    if (!found->is_string()) return Refusal::kMalformed;
    return value_of(options, quantity, with_unit(found->get_ref<const std::string&>()), is_direction);
  };
  const LineValue speed_m_s = value_at(options.speed, false);
  if (!speed_m_s) return speed_m_s.error();
  const LineValue direction_deg = value_at(options.direction, true);
  if (!direction_deg) return direction_deg.error();
  const LineValue gust_m_s = value_at(options.gust, false);
  if (!gust_m_s) return gust_m_s.error();
  if (!has_any) return Refusal::kNotMine;
  return LineValues{*speed_m_s, *direction_deg, *gust_m_s};
}

Result<LineValues, Refusal> values_of_line(const LineOptions& options, std::string_view line) {
  const bool is_auto = options.format == LineFormat::kAuto;
  if (options.format == LineFormat::kJson || (is_auto && line.front() == '{')) {
    try {
      return values_of_json(options, line);
    } catch (const std::exception&) {  // an index that no array has, or no memory; keys are looked at before
                                       // (is_json_pointer)
      return Refusal::kMalformed;
    }
  }
  const bool has_keys =
      options.format == LineFormat::kKeys || (is_auto && line.find_first_of("=:") != std::string_view::npos);
  const auto texts = has_keys ? texts_of_keys(options, line) : texts_of_columns(options, line);
  if (!texts) return texts.error();
  return values_of_texts(options, *texts);
}

}  // namespace

Result<DecodedWind, Refusal> decode_line(const LineOptions& options, std::string_view line) noexcept {
  line = trimmed(line);
  if (line.empty()) return Refusal::kTooShort;
  if (line.front() == '#') return Refusal::kNotMine;

  const auto values = values_of_line(options, line);
  if (!values) return values.error();
  DecodedWind wind;
  wind.reference = options.reference;
  wind.speed_m_s = values->speed_m_s;
  wind.gust_m_s = values->gust_m_s;
  if (values->direction_deg) {
    wind.direction_deg = wrapped_direction_deg(*values->direction_deg);
    if (!wind.direction_deg) return Refusal::kImplausible;
  }
  return checked(wind);
}

}  // namespace yuragi::drivers::decode::text
