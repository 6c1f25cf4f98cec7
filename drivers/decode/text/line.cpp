#include "drivers/decode/text/line.hpp"

#include <cmath>

namespace yuragi::drivers::decode::text {
namespace {

using LineValue = Result<std::optional<double>, Refusal>;

/// The three texts as they stand in the line.
struct LineTexts {
  std::string_view speed;
  std::string_view direction;
  std::string_view gust;
};

bool says_nothing(std::string_view text) {
  return text.empty() || text == "nan" || text == "NaN" || text == "NAN" || text == "null";
}

LineValue value_of(const LineOptions& options, const LineQuantity& quantity, std::string_view text) {
  if (says_nothing(text)) return std::optional<double>();
  const auto number = parse_number(text);
  if (!number) return number.error();
  if (*number == options.invalid) return std::optional<double>();
  const double value = **number * quantity.scale + quantity.offset;
  if (!std::isfinite(value)) return Refusal::kImplausible;
  return std::optional(value);
}

/// The next piece of `rest` that stands between separators; empty at the end.
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
    return quantity.column ? fields[*quantity.column] : std::string_view();
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

    const auto take = [&](const LineQuantity& quantity, std::string_view& into, bool& has) {
      if (quantity.key.empty() || key != quantity.key) return true;
      if (has) return false;
      has = true;
      into = text;
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

}  // namespace

Result<DecodedWind, Refusal> decode_line(const LineOptions& options, std::string_view line) noexcept {
  line = trimmed(line);
  if (line.empty()) return Refusal::kTooShort;
  if (line.front() == '#') return Refusal::kNotMine;

  const bool has_keys = options.format == LineFormat::kKeys ||
                        (options.format == LineFormat::kAuto && line.find_first_of("=:") != std::string_view::npos);
  const auto texts = has_keys ? texts_of_keys(options, line) : texts_of_columns(options, line);
  if (!texts) return texts.error();

  const LineValue speed_m_s = value_of(options, options.speed, texts->speed);
  if (!speed_m_s) return speed_m_s.error();
  const LineValue direction_deg = value_of(options, options.direction, texts->direction);
  if (!direction_deg) return direction_deg.error();
  const LineValue gust_m_s = value_of(options, options.gust, texts->gust);
  if (!gust_m_s) return gust_m_s.error();

  DecodedWind wind;
  wind.reference = options.reference;
  wind.speed_m_s = *speed_m_s;
  wind.gust_m_s = *gust_m_s;
  if (*direction_deg) {
    wind.direction_deg = wrapped_direction_deg(**direction_deg);
    if (!wind.direction_deg) return Refusal::kImplausible;
  }
  return checked(wind);
}

}  // namespace yuragi::drivers::decode::text
