#include "drivers/decode/marine/bus_line.hpp"

#include <algorithm>

#include "drivers/decode/marine/actisense.hpp"
#include "drivers/decode/marine/canboat_plain.hpp"
#include "drivers/decode/marine/yacht_devices.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

/// A line of a Signal K server's log, "1597516803000;A;" and what was received.
struct LoggedLine {
  std::string_view time_ms = {};  ///< empty: it is not of such a log
  char protocol = 'A';            ///< A: NMEA 2000; N: NMEA 0183; I: Signal K
  std::string_view line = {};
};

LoggedLine logged_line(std::string_view line) {
  line = trimmed(line);
  const std::size_t digits = static_cast<std::size_t>(
      std::ranges::find_if_not(line, [](char c) { return c >= '0' && c <= '9'; }) - line.begin());
  const std::string_view rest = line.substr(digits);
  if (digits == 0 || rest.size() < 3 || rest[0] != ';' || rest[2] != ';' || rest[1] < 'A' || rest[1] > 'Z')
    return {.line = line};
  return {.time_ms = line.substr(0, digits), .protocol = rest[1], .line = rest.substr(3)};
}

std::optional<BusLineFormat> format_by_look(std::string_view line) {
  if (trimmed(line).starts_with('{')) return BusLineFormat::kCanboat;
  if (looks_like_canboat_plain(line)) return BusLineFormat::kCanboatPlain;
  if (looks_like_actisense(line)) return BusLineFormat::kActisense;
  if (looks_like_yacht_devices(line)) return BusLineFormat::kYachtDevices;
  if (looks_like_candump(line)) return BusLineFormat::kCandump;
  return {};
}

/// The text of "timestamp" in JSON, without reading the JSON: a time has no escapes.
std::string_view json_time(std::string_view line) {
  constexpr std::string_view kName = "\"timestamp\"";
  std::size_t at = line.find(kName);
  if (at == line.npos) return {};
  line = trimmed(line.substr(at + kName.size()));
  if (!line.starts_with(':')) return {};
  line = trimmed(line.substr(1));
  if (!line.starts_with('"')) return {};
  line.remove_prefix(1);
  at = line.find('"');
  return at == line.npos ? std::string_view() : line.substr(0, at);
}

std::string_view candump_time(std::string_view line) {
  line = trimmed(line);
  const std::size_t end = line.find(')');
  if (!line.starts_with('(') || end == line.npos) return {};
  return trimmed(line.substr(1, end - 1));
}

BusLineTime time_in(BusLineFormat format, std::string_view line) {
  switch (format) {
    case BusLineFormat::kCanboat:
      return {.clock = BusLineClock::kDate, .text = json_time(line)};
    case BusLineFormat::kCanboatPlain:
      return {.clock = BusLineClock::kDate, .text = canboat_plain_time(line)};
    case BusLineFormat::kCandump:
      return {.clock = BusLineClock::kUnixSeconds, .text = candump_time(line)};
    case BusLineFormat::kActisense:
      return {.clock = BusLineClock::kMidnight, .text = actisense_time(line)};
    case BusLineFormat::kYachtDevices:
    case BusLineFormat::kAuto:
      break;
  }
  line = trimmed(line);
  return {.clock = BusLineClock::kMidnight, .text = line.substr(0, line.find(' '))};
}

}  // namespace

std::optional<BusLineFormat> bus_line_format_of(std::string_view line) noexcept {
  const auto format = format_by_look(logged_line(line).line);
  // Other programs print JSON, too.
  const bool is_of_another = format == BusLineFormat::kCanboat && line.find("\"pgn\"") == line.npos;
  return is_of_another ? std::nullopt : format;
}

std::optional<BusLineTime> bus_line_time(std::string_view line) noexcept {
  const LoggedLine logged = logged_line(line);
  if (const auto format = format_by_look(logged.line)) {
    const BusLineTime time = time_in(*format, logged.line);
    if (!time.text.empty()) return time;
  }
  if (logged.time_ms.empty()) return {};
  return BusLineTime{.clock = BusLineClock::kUnixMilliseconds, .text = logged.time_ms};
}

Result<BusWind, Refusal> BusLineDecoder::decode(std::string_view line) {
  const LoggedLine logged = logged_line(line);
  if (logged.protocol != 'A') return Refusal::kNotMine;
  const auto format = format_by_look(logged.line);
  if (options_.format == BusLineFormat::kAuto) {
    if (format) return decode_as(*format, logged.line);
    return trimmed(line).empty() ? Refusal::kTooShort : Refusal::kMalformed;
  }
  if (format && *format != options_.format) return Refusal::kMalformed;
  return decode_as(options_.format, logged.line);
}

Result<BusWind, Refusal> BusLineDecoder::decode_as(BusLineFormat format, std::string_view line) {
  switch (format) {
    case BusLineFormat::kCanboat:
      return decode_json(line);
    case BusLineFormat::kCandump:
      return decode_dump(line);
    case BusLineFormat::kCanboatPlain:
      return decode_canboat_plain(line);
    case BusLineFormat::kActisense:
      return decode_actisense(line);
    case BusLineFormat::kYachtDevices:
    case BusLineFormat::kAuto:
      break;
  }
  return decode_yacht_devices(line);
}

Result<BusWind, Refusal> BusLineDecoder::decode_json(std::string_view line) {
  if (const auto told = canboat_angle_unit(line); told && !options_.angle_unit) angle_unit_ = told;
  const auto said = decode_canboat({.angle_unit = angle_unit_}, line);
  // Without a known unit only angles that must be in degrees are decoded.
  if (said && said->wind.direction_deg && !angle_unit_) angle_unit_ = AngleUnit::kDegrees;
  lacks_angle_unit_ = said && !angle_unit_;
  return said;
}

Result<BusWind, Refusal> BusLineDecoder::decode_dump(std::string_view line) {
  if (const auto told = candump_controller_state(line)) controller_ = *told;
  const auto said = decode_candump(line);
  if (said && controller_ == ControllerState::kBusOff) controller_ = ControllerState::kGood;  // it takes part again
  return said;
}

}  // namespace yuragi::drivers::decode::marine
