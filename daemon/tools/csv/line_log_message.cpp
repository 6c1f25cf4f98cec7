#include "daemon/tools/csv/line_log_message.hpp"

#include <algorithm>
#include <utility>

#include "drivers/decode/text/ft.hpp"
#include "drivers/decode/text/gill.hpp"
#include "drivers/decode/text/line.hpp"
#include "drivers/decode/text/nmea.hpp"
#include "drivers/decode/text/umb.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::daemon::tools::csv {
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

LineLogMessage dollar_message(std::string_view line, std::size_t dollar) {
  const std::string_view text = line.substr(dollar);
  LineLogMessage message{line.substr(0, dollar), {}, Refusal::kNotMine, std::nullopt};
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
std::optional<LineLogMessage> gill_message(std::string_view line) {
  constexpr char kStx = '\x02';
  constexpr std::string_view kBefore = " \t,;|>])";
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const bool begins = line[i] == kStx || (is_capital_or_digit(line[i]) && line[i] >= 'A' && line[i + 1] == ',' &&
                                            (i == 0 || kBefore.find(line[i - 1]) != std::string_view::npos));
    if (!begins) continue;
    const std::string_view text = line.substr(i);
    const decode::text::GillOptions options{
        .checksum = WhenMissing::kAccept, .status = WhenMissing::kAccept, .node = std::nullopt};
    LineLogMessage message{line.substr(0, i), {}, decode::text::decode_gill(options, text), std::nullopt};
    if (!message.wind && line[i] != kStx && message.wind.error() != Refusal::kInvalid &&
        message.wind.error() != Refusal::kBadChecksum) {
      continue;
    }
    const char node = line[i] == kStx ? line[i + 1] : line[i];
    message.source = std::string("Gill of ") + node;
    return message;
  }
  return std::nullopt;
}

std::optional<LineLogMessage> keys_message(std::string_view line) {
  const std::size_t begin = std::min({line.find("speed"), line.find("direction"), line.find("gust")});
  if (begin == std::string_view::npos) return std::nullopt;
  decode::text::LineOptions options;
  options.format = decode::text::LineFormat::kKeys;
  LineLogMessage message{
      line.substr(0, begin), {}, decode::text::decode_line(options, line.substr(begin)), std::nullopt};
  if (!message.wind && message.wind.error() == Refusal::kNotMine) return std::nullopt;
  message.source = "keys";
  return message;
}

}  // namespace

std::optional<LineLogMessage> find_message(std::string_view line) {
  const std::size_t dollar = line.rfind('$');
  if (dollar != std::string_view::npos) return dollar_message(line, dollar);
  if (auto message = gill_message(line)) return message;
  return keys_message(line);
}

}  // namespace yuragi::daemon::tools::csv
