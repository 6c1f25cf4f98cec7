#include "drivers/decode/text/line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>

#include <nlohmann/json.hpp>

#include "drivers/decode/speed_units.hpp"
#include "engine/base/compass.hpp"

namespace yuragi::drivers::decode::text {
namespace {

using LineValue = Result<std::optional<double>, Refusal>;

/// A value's text, and the unit after it.
struct LineText {
  std::string_view number = {};
  std::string_view unit = {};
};
/// The texts of the quantities that a line names.
struct LineTexts {
  std::optional<LineText> speed = {};
  std::optional<LineText> direction = {};
  std::optional<LineText> gust = {};
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
  if (is_direction && text.unit.empty()) {
    if (const auto point_deg = compass_point_deg(text.number)) return point_deg;
    if (text.number == "VRB") return std::optional<double>();
  }
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

  bool has_any = false;
  const auto column = [&](const LineQuantity& quantity) -> std::optional<LineText> {
    if (!quantity.column) return std::nullopt;
    has_any |= *quantity.column < fields.count;
    return with_unit(fields[*quantity.column]);
  };
  const LineTexts texts{column(options.speed), column(options.direction), column(options.gust)};
  if (!has_any) return Refusal::kMalformed;
  return texts;
}

constexpr std::string_view kLineBlanks = " \t";
constexpr std::string_view kLineSeparators = " \t,;&";
constexpr std::string_view kLineSigns = "=:";  // between key and value

/// Removes a sign, and the blanks before it, from the beginning of `rest`. Returns false if something else begins it.
bool take_sign(std::string_view& rest) {
  const std::size_t sign = rest.find_first_not_of(kLineBlanks);
  if (sign == std::string_view::npos || kLineSigns.find(rest[sign]) == std::string_view::npos) return false;
  rest.remove_prefix(sign + 1);
  return true;
}

/// Removes a value that follows after blanks ("speed: 4.2") from the beginning of `rest`, and returns it; empty if a
/// separator or the next key follows.
std::string_view take_value(std::string_view& rest) {
  const std::size_t start = rest.find_first_not_of(kLineBlanks);
  if (start == 0 || start == std::string_view::npos) return {};
  std::string_view behind = rest.substr(start);
  const std::string_view word = behind.substr(0, behind.find_first_of(kLineSeparators));
  behind.remove_prefix(word.size());
  std::string_view ahead = behind;
  if (word.find_first_of(kLineSigns) != std::string_view::npos || take_sign(ahead)) return {};
  if (!word.empty()) rest = behind;
  return word;
}

/// A key, and the text of its value.
struct LinePair {
  std::string_view key;
  LineText value = {};
};

/// Returns the pair whose first piece is `piece`, and removes the rest of it from `line`.
LinePair pair_at(std::string_view piece, std::string_view& line) {
  const std::size_t sign = piece.find_first_of(kLineSigns);
  LinePair pair = {.key = piece.substr(0, sign)};
  std::string_view text;
  if (sign != std::string_view::npos) {
    text = piece.substr(sign + 1);
  } else if (take_sign(line)) {  // "speed =4.2"
    text = line.substr(0, line.find_first_of(kLineSeparators));
    line.remove_prefix(text.size());
  } else {
    return pair;
  }
  if (text.empty()) text = take_value(line);

  pair.value = with_unit(text);
  if (pair.value.unit.empty() && !pair.value.number.empty()) {  // "4.2 km/h"
    std::string_view ahead = line;
    const std::string_view word = next_piece(ahead, kLineBlanks);
    const std::string_view unit = word.substr(0, word.find_first_of(",;&"));
    if (is_unit(unit)) {
      pair.value.unit = unit;
      line.remove_prefix(static_cast<std::size_t>(unit.data() + unit.size() - line.data()));
    }
  }
  return pair;
}

Result<LineTexts, Refusal> texts_of_keys(const LineOptions& options, std::string_view line) {
  LineTexts texts;
  for (std::string_view piece; !(piece = next_piece(line, kLineSeparators)).empty();) {
    const LinePair pair = pair_at(piece, line);
    const auto take = [&](const LineQuantity& quantity, std::optional<LineText>& into) {
      if (quantity.key.empty() || pair.key != quantity.key) return true;
      if (into) return false;
      into = pair.value;
      return true;
    };
    const bool is_first_of_its_key =
        take(options.speed, texts.speed) && take(options.direction, texts.direction) && take(options.gust, texts.gust);
    if (!is_first_of_its_key) return Refusal::kMalformed;
  }
  if (!texts.speed && !texts.direction && !texts.gust) return Refusal::kNotMine;
  return texts;
}

/// The three values, in m/s and degrees, of the quantities that a line names.
struct LineValues {
  LineValues() = default;  // no aggregate: a Refusal must not become a value of it

  std::optional<LineValue> speed_m_s = {};
  std::optional<LineValue> direction_deg = {};
  std::optional<LineValue> gust_m_s = {};
};

LineValues values_of_texts(const LineOptions& options, const LineTexts& texts) {
  LineValues values;
  if (texts.speed) values.speed_m_s = value_of(options, options.speed, *texts.speed, false);
  if (texts.direction) values.direction_deg = value_of(options, options.direction, *texts.direction, true);
  if (texts.gust) values.gust_m_s = value_of(options, options.gust, *texts.gust, false);
  return values;
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
  const auto value_at = [&](const LineQuantity& quantity, bool is_direction) -> std::optional<LineValue> {
    const nlohmann::json* found = quantity.key.empty() ? nullptr : find_in(object, quantity.key);
    if (found == nullptr) return std::nullopt;
    if (found->is_null()) return LineValue(std::optional<double>());
    if (found->is_number()) return scaled(options, quantity, found->get<double>(), std::nullopt);
    if (!found->is_string()) return LineValue(Refusal::kMalformed);
    return value_of(options, quantity, with_unit(found->get_ref<const std::string&>()), is_direction);
  };
  LineValues values;
  values.speed_m_s = value_at(options.speed, false);
  values.direction_deg = value_at(options.direction, true);
  values.gust_m_s = value_at(options.gust, false);
  if (!values.speed_m_s && !values.direction_deg && !values.gust_m_s) return Refusal::kNotMine;
  return values;
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

/// Adds the direction, or why it cannot be read.
void add_direction(const LineValue& direction_deg, LineWind& line) {
  if (!direction_deg) {
    line.direction_refusal = direction_deg.error();
  } else if (*direction_deg) {
    line.wind.direction_deg = wrapped_direction_deg(**direction_deg);
    if (!line.wind.direction_deg) line.direction_refusal = Refusal::kImplausible;
  }
  if (line.direction_refusal) line.wind.status = DecodedStatus::kUncertain;
}

/// Returns true if the line has a byte that only damage puts there.
bool has_control_byte(std::string_view line) {
  return std::ranges::any_of(line, [](unsigned char c) { return (c < ' ' && c != '\t') || c == '\x7f'; });
}

bool is_empty(const DecodedWind& wind) {
  return !wind.speed_m_s && !wind.direction_deg && !wind.gust_m_s;
}

}  // namespace

Result<LineWind, Refusal> read_line(const LineOptions& options, std::string_view line) noexcept {
  line = trimmed(line);
  if (line.empty()) return Refusal::kTooShort;
  if (line.front() == '#') return Refusal::kNotMine;
  if (has_control_byte(line)) return Refusal::kMalformed;

  const auto values = values_of_line(options, line);
  if (!values) return values.error();
  LineWind read;
  read.names_speed = values->speed_m_s.has_value();
  read.names_direction = values->direction_deg.has_value();
  read.names_gust = values->gust_m_s.has_value();
  read.wind.reference = options.reference;
  if (read.names_speed) {
    if (!*values->speed_m_s) return values->speed_m_s->error();
    read.wind.speed_m_s = **values->speed_m_s;
  }
  if (read.names_gust) {
    if (!*values->gust_m_s) return values->gust_m_s->error();
    read.wind.gust_m_s = **values->gust_m_s;
  }
  if (read.names_direction) add_direction(*values->direction_deg, read);
  if (is_empty(read.wind)) return read;
  const auto sound = checked(read.wind);
  if (!sound) return sound.error();
  read.wind = *sound;
  return read;
}

Result<DecodedWind, Refusal> decode_line(const LineOptions& options, std::string_view line) noexcept {
  const auto read = read_line(options, line);
  if (!read) return read.error();
  if (is_empty(read->wind)) return read->direction_refusal.value_or(Refusal::kInvalid);
  return read->wind;
}

}  // namespace yuragi::drivers::decode::text
