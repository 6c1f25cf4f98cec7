#include "daemon/tools/logs/message_finder.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "daemon/tools/logs/log_time.hpp"
#include "drivers/decode/davis/weatherlink_live.hpp"
#include "drivers/decode/marine/signalk.hpp"
#include "drivers/decode/network/tempest.hpp"
#include "drivers/decode/text/ft.hpp"
#include "drivers/decode/text/gill.hpp"
#include "drivers/decode/text/nmea.hpp"
#include "drivers/decode/text/umb.hpp"
#include "drivers/decode/text/wxt.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::daemon::tools::logs {
namespace {

namespace decode = drivers::decode;
using decode::Refusal;
using decode::WhenMissing;

bool is_capital_or_digit(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// "$WIMWV,214.8,R,..." is "MWV R of WI".
std::string nmea_source(std::string_view sentence) {
  const decode::TextFields fields = decode::split_fields(sentence, ',');
  const std::string_view word = fields[0];
  std::string name(word.size() > 3 ? word.substr(word.size() - 3) : word);
  if (name == "MWV") name += " " + std::string(fields[2]);
  return name + " of " + std::string(word.substr(0, word.size() - std::min<std::size_t>(3, word.size())));
}

Message dollar_message(std::string_view line, std::size_t dollar) {
  const std::string_view text = line.substr(dollar);
  Message message;
  message.prefix = line.substr(0, dollar);
  if (text.starts_with("$ ")) {
    message.wind = decode::text::decode_umb({}, text);
    message.source = "UMB";
  } else if (text.find(",WVP=") != std::string_view::npos) {
    message.wind = decode::text::decode_ft({}, text);
    message.source = "FT";
  } else {
    const decode::text::NmeaOptions options{.checksum = WhenMissing::kAccept, .status = WhenMissing::kAccept};
    message.wind = decode::text::decode_nmea(options, text);
    message.quantities = decode::text::decode_nmea_quantities(options, text);
    if (const auto sentence = decode::sentence_of(text, WhenMissing::kAccept)) message.source = nmea_source(*sentence);
  }
  return message;
}

/// Gill's messages begin with STX, or with the letter of a node and a comma.
std::optional<Message> gill_message(std::string_view line) {
  constexpr char kStx = '\x02';
  constexpr std::string_view kBefore = " \t,;|>])";
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const bool begins = line[i] == kStx || (is_capital_or_digit(line[i]) && line[i] >= 'A' && line[i + 1] == ',' &&
                                            (i == 0 || kBefore.find(line[i - 1]) != std::string_view::npos));
    if (!begins) continue;
    const std::string_view text = line.substr(i);
    const decode::text::GillOptions options{
        .checksum = WhenMissing::kAccept, .status = WhenMissing::kAccept, .node = std::nullopt};
    Message message;
    message.prefix = line.substr(0, i);
    message.wind = decode::text::decode_gill(options, text);
    // Without its first byte a letter and a comma are no message: tables have them, too.
    const bool has_end = text.find('\x03') != std::string_view::npos;
    if (!message.wind && line[i] != kStx && !has_end) continue;
    const char node = line[i] == kStx ? line[i + 1] : line[i];
    message.source = std::string("Gill of ") + node;
    return message;
  }
  return std::nullopt;
}

/// Vaisala's begin with an address, R or r, and a digit: "0R1,Dn=236D,...".
std::optional<Message> wxt_message(std::string_view line) {
  const decode::text::WxtOptions options{.checksum = WhenMissing::kAccept};
  for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',', comma + 1)) {
    if (comma < 3) continue;
    const std::string_view text = line.substr(comma - 3);
    if (!decode::text::looks_like_wxt(text)) continue;
    Message message;
    message.prefix = line.substr(0, comma - 3);
    message.source = std::string("WXT ") + text[0];
    message.wind = decode::text::decode_wxt(options, text);
    message.quantities = decode::text::decode_wxt_quantities(options, text);
    return message;
  }
  return std::nullopt;
}

/// A hub's message of any kind has these keys.
bool is_of_tempest(std::string_view text) {
  return text.find("\"serial_number\"") != std::string_view::npos && text.find("\"type\"") != std::string_view::npos;
}

}  // namespace

std::optional<Message> MessageFinder::tempest_message(std::string_view text) {
  const auto decoded = decode::network::decode_tempest(text);
  Message message;
  if (!decoded) {
    message.wind = decoded.error();
    return message;
  }
  if (decoded->kind == decode::network::TempestKind::kOther) return message;
  auto& winds = tempests_[decoded->serial_number];
  if (!winds.is_new(*decoded)) return message;
  message.source = "Tempest " + decoded->serial_number;
  if (!decoded->wind || winds.is_wind(*decoded)) message.wind = decoded->wind;
  message.quantities = decoded->quantities;
  message.time = csv::parse_time(std::to_string(decoded->time_s), csv::TimeFormat::kUnix);
  return message;
}

std::optional<Message> MessageFinder::json_message(std::string_view text) {
  if (is_of_tempest(text)) return tempest_message(text);
  if (text.find("\"conditions\"") != std::string_view::npos) {
    Message message;
    const auto conditions = decode::davis::decode_live_conditions(text, 0);
    if (!conditions) {
      message.wind = conditions.error();
      return message;
    }
    message.source = "WeatherLink " + conditions->device;
    message.wind = conditions->wind;
    message.quantities = conditions->quantities;
    if (conditions->time_s)
      message.time = csv::parse_time(fmt::format("{}", *conditions->time_s), csv::TimeFormat::kUnix);
    return message;
  }
  if (text.find("\"updates\"") != std::string_view::npos) {
    const auto delta = decode::marine::decode_signalk(text);
    Message message;
    if (!delta) {
      message.wind = delta.error();
      return message;
    }
    for (const decode::marine::SignalKUpdate& update : delta->updates) {
      for (const auto& wind : decode::marine::signalk_winds(update.values)) {
        if (!wind || message.wind) continue;
        message.source = fmt::format("Signal K {} of {}", wind->frame, update.source);
        message.wind = wind->wind;
        message.time = leading_time(update.timestamp, csv::TimeFormat::kIso);
      }
    }
    return message;
  }
  return std::nullopt;
}

/// A line of NMEA 2000, whatever it is about; a wind's source has its frame.
std::optional<Message> MessageFinder::bus_message(std::string_view line) {
  const auto format = decode::marine::bus_line_format_of(line);
  if (!format) return std::nullopt;
  Message message;
  const auto decoded = bus_.decode(line);
  if (!decoded) {
    // Other lines can begin in the same way.
    if (decoded.error() == Refusal::kMalformed || decoded.error() == Refusal::kTooShort) return std::nullopt;
    message.wind = decoded.error();
  } else {
    message.wind = decoded->wind;
    message.source =
        fmt::format("NMEA 2000 ({}), {}", decode::marine::kBusLineFormatNames[static_cast<std::size_t>(*format)],
                    name_of(decoded->wind.reference));
  }
  const auto time = decode::marine::bus_line_time(line);
  if (!time) return message;
  if (time->clock == decode::marine::BusLineClock::kMidnight) {
    message.time_of_day = time_of_day_in(time->text);
  } else {
    message.time = leading_time(time->text, csv::TimeFormat::kAuto);
  }
  return message;
}

std::optional<Message> MessageFinder::find(std::string_view line) {
  if (auto message = bus_message(line)) return message;
  if (const auto brace = line.find('{'); brace != std::string_view::npos) {
    if (auto message = json_message(line.substr(brace))) {
      message->prefix = line.substr(0, brace);
      return message;
    }
    return keys_.take(line);
  }
  const std::size_t dollar = line.rfind('$');
  if (dollar != std::string_view::npos) {
    auto message = dollar_message(line, dollar);
    // A microcontroller's keys can begin with it, too.
    if (!message.wind && line.find('=', dollar) != std::string_view::npos) {
      if (auto keys = keys_.take(line)) return keys;
    }
    return message;
  }
  if (auto message = wxt_message(line)) return message;
  if (auto message = gill_message(line)) return message;
  return keys_.take(line);
}

std::optional<Message> MessageFinder::finish() {
  return keys_.finish();
}

}  // namespace yuragi::daemon::tools::logs
