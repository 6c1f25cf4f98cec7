#include "drivers/text/nmea_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "drivers/decode/text/ft.hpp"
#include "drivers/decode/text/gill.hpp"
#include "drivers/decode/text/nmea.hpp"
#include "drivers/decode/text/umb.hpp"
#include "drivers/decode/text/wxt.hpp"

namespace yuragi::drivers::text {
namespace {

/// A direction and a speed that come in two messages belong together if they come so close, or within one pause and a
/// half of the directions.
constexpr Nanoseconds kJoinTime = std::chrono::seconds(2);
/// Below this anemometers leave out the direction.
constexpr double kVaneCalm_m_s = 0.5;

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

/// Talker and sentence of a decoded line, in capitals but for other formats than NMEA's.
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

}  // namespace

NmeaSensor::NmeaSensor(NmeaSensorSettings settings, std::unique_ptr<bus::BytePort> port)
    : TextSensor(settings.text, std::move(port)), settings_(std::move(settings)), choice_(settings_.wind.frame) {}

void NmeaSensor::begin() {
  choice_.restart();
  held_.reset();
  kept_direction_.reset();
}

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

TextSensor::Judgement NmeaSensor::judge(std::string_view line, const Instant& now) {
  const NmeaFormat format = settings_.format == NmeaFormat::kAuto ? format_by_look(line) : settings_.format;
  const auto wind = decode(format, line);
  if (!wind) return wind.error();

  // Is it one of the configured sentences?
  const MessageName message = name_of_message(format, line);
  const bool is_wanted = settings_.sentences.empty() ||
                         std::ranges::find(settings_.sentences, message.sentence) != settings_.sentences.end();
  if (!is_wanted || (!settings_.talker.empty() && message.talker != settings_.talker)) return decode::Refusal::kNotMine;

  // Publish it, or has another source sent the same?
  const WindChoice::Source source = {.name = fmt::format("{} of {}", message.sentence, message.talker),
                                     .frame = frame_of(message.sentence, wind->reference)};
  const bool is_calm = wind->speed_m_s && *wind->speed_m_s < kVaneCalm_m_s;
  const WindChoice::Said said = {
      .has_speed = wind->speed_m_s.has_value(), .has_direction = wind->direction_deg.has_value(), .is_calm = is_calm};
  const auto verdict = choice_.offer(source, said, now.mono);
  if (verdict == WindChoice::Verdict::kForeign) return decode::Refusal::kNotMine;

  // The speed may come in another message than the direction.
  std::optional<double> direction_deg =
      choice_.takes_direction() ? direction_from_north_deg(settings_.wind, *wind) : std::nullopt;
  if (direction_deg) {
    kept_direction_ = KeptDirection{source.name, *direction_deg, now.mono, !said.has_speed};
    if (held_ && !held_->direction_deg) held_->direction_deg = direction_deg;
  }
  if (verdict == WindChoice::Verdict::kPass) return std::optional<wind::WindReading>();
  if (!direction_deg) direction_deg = direction_for(source.name, now.mono);

  const bool is_uncertain = wind->status == decode::DecodedStatus::kUncertain;
  const wind::WindReading reading = {
      .time = now,
      .speed_m_s = *wind->speed_m_s,
      .direction_deg = direction_deg,
      .gust_m_s = wind->gust_m_s,
      .quality = is_uncertain ? wind::ReadingQuality::kUncertain : wind::ReadingQuality::kGood};
  name_sources(source.name, reading, is_calm);
  const bool comes_in_bursts = settings().poll_interval == Nanoseconds::zero();
  if (verdict == WindChoice::Verdict::kHold && comes_in_bursts) {
    held_ = reading;
    return std::optional<wind::WindReading>();
  }
  held_.reset();
  return std::optional(reading);
}

/// The direction that belongs to a speed whose own message has none. In a calm a message leaves it out on purpose: then
/// the one before does not hold.
std::optional<double> NmeaSensor::direction_for(const std::string& source, MonoTime now) {
  if (!kept_direction_) return std::nullopt;
  const KeptDirection kept = *kept_direction_;
  if (kept.came_alone) kept_direction_.reset();
  const Nanoseconds longest = std::max<Nanoseconds>(kJoinTime, choice_.direction_pause() * 3 / 2);
  if (now - kept.time > longest || (kept.source == source && !kept.came_alone)) return std::nullopt;
  return kept.direction_deg;
}

/// What speed and direction are taken from: a change of it is logged.
void NmeaSensor::name_sources(const std::string& source, const wind::WindReading& reading, bool is_calm) {
  const std::string& direction_source = choice_.direction_source();
  if (direction_source.empty() || direction_source == source) {
    taken_ = source;
  } else if (reading.direction_deg) {
    taken_ = fmt::format("{} with the direction of {}", source, direction_source);
  } else if (!is_calm) {
    taken_ = fmt::format("{} without a direction, since {} gives none", source, direction_source);
  }
}

/// Of any sentence of the talker: `sentences` says where the wind is taken from.
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

std::optional<wind::WindReading> NmeaSensor::take_held() {
  if (held_) choice_.settle();
  return std::exchange(held_, std::nullopt);
}

std::string NmeaSensor::name() const {
  return taken_.empty() ? "anemometer" : taken_;
}

std::string NmeaSensor::advice(decode::Refusal why, std::string_view line) const {
  const std::string where = describe(settings().address);
  const bool is_wxt = decode::text::looks_like_wxt(line);
  const bool has_checksum = is_wxt ? decode::trimmed(line)[1] == 'r' : line.find_first_of("*\x03") != line.npos;
  if (why == decode::Refusal::kBadChecksum && !has_checksum) {
    return "lines arrive from " + where +
           " without a checksum: set the device to send one, or missing_checksum to \"accept\"";
  }
  if (why == decode::Refusal::kMalformed && settings_.status == decode::WhenMissing::kRefuse) {
    return TextSensor::advice(why, line) + "; if they have no status, set missing_status to \"accept\"";
  }
  if (why == decode::Refusal::kNotMine) {
    return TextSensor::advice(why, line) +
           " (format, sentences, talker, reference), and what the device is set to send";
  }
  return TextSensor::advice(why, line);
}

}  // namespace yuragi::drivers::text
