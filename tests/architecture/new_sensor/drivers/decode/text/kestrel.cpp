#include "drivers/decode/text/kestrel.hpp"

namespace yuragi::drivers::decode::text {

Result<DecodedWind, Refusal> decode_kestrel(std::string_view line) noexcept {
  const auto sentence = sentence_of(line, WhenMissing::kRefuse);
  if (!sentence) return sentence.error();
  const TextFields fields = split_fields(*sentence, ',');
  if (fields[0] != "K") return Refusal::kNotMine;
  if (fields.count != 3) return Refusal::kMalformed;

  const auto speed_m_s = parse_number(fields[1]);
  if (!speed_m_s) return speed_m_s.error();
  const auto direction_deg = parse_direction_deg(fields[2]);
  if (!direction_deg) return direction_deg.error();
  DecodedWind wind;
  wind.reference = WindReference::kRelative;
  wind.speed_m_s = *speed_m_s;
  wind.direction_deg = *direction_deg;
  return checked(wind);
}

}  // namespace yuragi::drivers::decode::text
