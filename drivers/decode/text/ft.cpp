#include "drivers/decode/text/ft.hpp"

#include "drivers/decode/text/nmea.hpp"

namespace yuragi::drivers::decode::text {

Result<DecodedWind, Refusal> decode_ft(const FtOptions& options, std::string_view line) noexcept {
  const auto sentence = sentence_of(line, options.checksum);
  if (!sentence) return sentence.error();
  const TextFields fields = split_fields(*sentence, ',');

  constexpr std::string_view kCommand = "WVP=";
  if (fields[0].size() == 5 && fields[0].ends_with("MWV")) {
    return decode_nmea({.checksum = options.checksum, .status = options.status, .xdr_first_id = 0}, line);
  }
  if (fields[0].size() != 2 || !fields[1].starts_with(kCommand)) return Refusal::kNotMine;
  if (fields.count > 4) return Refusal::kMalformed;

  DecodedWind wind;
  wind.reference = WindReference::kRelative;
  if (fields[3].empty()) {
    if (options.status == WhenMissing::kRefuse) return Refusal::kMalformed;
    wind.status = DecodedStatus::kUncertain;
  } else if (fields[3] != "0") {
    return Refusal::kInvalid;
  }

  const auto speed_m_s = parse_number(fields[1].substr(kCommand.size()));
  if (!speed_m_s) return speed_m_s.error();
  const auto direction_deg = parse_direction_deg(fields[2]);
  wind.speed_m_s = *speed_m_s;
  if (!direction_deg && !wind.speed_m_s) return direction_deg.error();
  if (direction_deg) {
    wind.direction_deg = *direction_deg;
  } else {
    wind.status = DecodedStatus::kUncertain;  // the speed is still one
  }
  return checked(wind);
}

}  // namespace yuragi::drivers::decode::text
