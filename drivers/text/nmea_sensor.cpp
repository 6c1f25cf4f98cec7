#include "drivers/text/nmea_sensor.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "drivers/decode/text/ft.hpp"
#include "drivers/decode/text/gill.hpp"
#include "drivers/decode/text/nmea.hpp"
#include "drivers/decode/text/umb.hpp"
#include "drivers/decode/text/wxt.hpp"

namespace yuragi::drivers::text {
namespace {

/// The format of a line. Gill's begin with one letter, and have an ETX before the checksum.
NmeaFormat format_by_look(std::string_view line) {
  const std::string_view text = decode::trimmed(line);
  if (decode::text::looks_like_wxt(text)) return NmeaFormat::kWxt;
  const std::size_t dollar = text.rfind('$');
  if (dollar == std::string_view::npos) {
    const bool has_node = text.size() > 2 && text[0] >= 'A' && text[0] <= 'Z' && text[1] == ',';
    return has_node ? NmeaFormat::kGill : NmeaFormat::kNmea;
  }
  const std::string_view sentence = text.substr(dollar);
  if (sentence.starts_with("$ ")) return NmeaFormat::kUmb;
  return sentence.find(",WVP=") != std::string_view::npos ? NmeaFormat::kFt : NmeaFormat::kNmea;
}

/// Talker and sentence of a decoded line, in capitals for NMEA only.
struct MessageName {
  std::string talker;
  std::string sentence;
};

std::string in_capitals(std::string_view text) {
  std::string capitals(text);
  for (char& c : capitals) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return capitals;
}

MessageName name_of_message(NmeaFormat format, std::string_view line) {
  const std::string_view text = decode::trimmed(line);
  const std::size_t dollar = text.rfind('$');
  const std::string_view sentence = dollar == std::string_view::npos ? text : text.substr(dollar + 1);
  const std::string_view word = sentence.substr(0, sentence.find(','));
  if (format == NmeaFormat::kWxt) return {.talker = std::string(word.substr(0, 1)), .sentence = "WXT"};
  if (dollar == std::string_view::npos) return {.talker = std::string(word), .sentence = "Gill"};
  if (sentence.starts_with(' ')) return {.talker = std::string(decode::split_fields(text, ' ')[1]), .sentence = "UMB"};
  if (format == NmeaFormat::kFt && word.size() == 2) return {.talker = std::string(word), .sentence = "WVP"};
  const std::size_t talker_size = std::min<std::size_t>(2, word.size());
  return {.talker = in_capitals(word.substr(0, talker_size)), .sentence = in_capitals(word.substr(talker_size))};
}

/// The frame of MWD and MDA follows from the sentence: in a calm they leave out the direction, and its letter.
WindFrame frame_of(std::string_view sentence, decode::WindReference reference) {
  if (sentence == "MWD" || sentence == "MDA") return WindFrame::kNorth;
  return frame_of_reference(reference);
}

/// Returns true for a line that looks like NMEA 0183, but is none of its sentences of the wind.
bool is_foreign_sentence(std::string_view line) {
  if (format_by_look(line) != NmeaFormat::kNmea) return false;
  const auto wind = decode::text::decode_nmea({.checksum = decode::WhenMissing::kAccept}, line);
  return !wind && wind.error() == decode::Refusal::kNotMine;
}

}  // namespace

NmeaSensor::NmeaSensor(NmeaSensorSettings settings, std::unique_ptr<bus::BytePort> port)
    : Sensor(settings.text, std::move(port)), settings_(std::move(settings)), wind_(settings_.wind) {}

Result<decode::DecodedWind, decode::Refusal> NmeaSensor::decode(NmeaFormat format, std::string_view line) const {
  switch (format) {
    case NmeaFormat::kGill: {
      decode::text::GillOptions options;
      options.checksum = settings_.makers_checksum;
      options.status = settings_.status;
      return decode::text::decode_gill(options, line);
    }
    case NmeaFormat::kFt:
      return decode::text::decode_ft({.checksum = settings_.makers_checksum, .status = settings_.status}, line);
    case NmeaFormat::kUmb: {
      decode::text::UmbOptions options;
      options.checksum = settings_.makers_checksum;
      options.status = settings_.status;
      options.speed_range_m_s = settings_.speed_range_m_s;
      return decode::text::decode_umb(options, line);
    }
    case NmeaFormat::kWxt:
      return decode::text::decode_wxt({.checksum = settings_.checksum}, line);
    case NmeaFormat::kAuto:
    case NmeaFormat::kNmea:
      break;
  }
  return decode::text::decode_nmea(
      {.checksum = settings_.checksum, .status = settings_.status, .xdr_first_id = settings_.xdr_first_id}, line);
}

Sensor::Judgement NmeaSensor::judge(std::string_view line, const Instant& now) {
  const NmeaFormat format = settings_.format == NmeaFormat::kAuto ? format_by_look(line) : settings_.format;
  const auto wind = decode(format, line);
  if (!wind) return wind.error();

  // Refuses sentences that are not configured.
  const MessageName message = name_of_message(format, line);
  const bool is_wanted = settings_.sentences.empty() ||
                         std::ranges::find(settings_.sentences, message.sentence) != settings_.sentences.end();
  if (!is_wanted || (!settings_.talker.empty() && message.talker != settings_.talker)) return decode::Refusal::kNotMine;

  return wind_.offer({.name = fmt::format("{} of {}", message.sentence, message.talker),
                      .frame = frame_of(message.sentence, wind->reference)},
                     *wind, now);
}

/// Accepts any sentence of the talker: `sentences` selects only those of the wind.
std::optional<wind::StationQuantities> NmeaSensor::quantities_of(std::string_view line) const {
  const NmeaFormat format = settings_.format == NmeaFormat::kAuto ? format_by_look(line) : settings_.format;
  if (!settings_.talker.empty() && name_of_message(format, line).talker != settings_.talker) return {};
  switch (format) {
    case NmeaFormat::kNmea:
      return decode::text::decode_nmea_quantities(
          {.checksum = settings_.checksum, .status = settings_.status, .xdr_first_id = settings_.xdr_first_id}, line);
    case NmeaFormat::kGill: {
      decode::text::GillOptions options;
      options.checksum = settings_.makers_checksum;
      options.status = settings_.status;
      return decode::text::decode_gill_quantities(options, line);
    }
    case NmeaFormat::kWxt:
      return decode::text::decode_wxt_quantities({.checksum = settings_.checksum}, line);
    case NmeaFormat::kAuto:
    case NmeaFormat::kFt:
    case NmeaFormat::kUmb:
      break;
  }
  return {};
}

std::string NmeaSensor::name() const {
  return wind_.taken().empty() ? "anemometer" : wind_.taken();
}

std::string NmeaSensor::advice(decode::Refusal why, std::string_view line) const {
  const std::string where = describe(settings().address);
  const bool is_wxt = decode::text::looks_like_wxt(line);
  const bool has_checksum = is_wxt ? decode::trimmed(line)[1] == 'r' : line.find_first_of("*\x03") != line.npos;
  if (why == decode::Refusal::kBadChecksum && !has_checksum) {
    if (is_foreign_sentence(line)) return advice(decode::Refusal::kNotMine, line);
    return "lines arrive from " + where +
           " without a checksum: set the device to send one, or missing_checksum to \"accept\"";
  }
  if (why == decode::Refusal::kMalformed && settings_.status == decode::WhenMissing::kRefuse) {
    return Sensor::advice(why, line) + "; if they have no status field, set missing_status to \"accept\"";
  }
  if (why == decode::Refusal::kNotMine) {
    return Sensor::advice(why, line) + " (format, sentences, talker, reference), and what the device is set to send";
  }
  return Sensor::advice(why, line);
}

}  // namespace yuragi::drivers::text
