// Any bytes as what a text protocol sends, in pieces of any size, with every policy: lines stay bounded, and a reading
// has something in it and is physical.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "drivers/decode/text/ft.hpp"
#include "drivers/decode/text/gill.hpp"
#include "drivers/decode/text/line.hpp"
#include "drivers/decode/text/line_assembler.hpp"
#include "drivers/decode/text/nmea.hpp"
#include "drivers/decode/text/umb.hpp"
#include "drivers/decode/text/wxt.hpp"
#include "engine/wind/wind_reading.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

void require_text(bool holds) {
  if (!holds) std::abort();
}

void require_physical(const Result<decode::DecodedWind, decode::Refusal>& decoded) {
  if (!decoded) return;
  require_text(decoded->speed_m_s || decoded->direction_deg || decoded->gust_m_s);
  const double speed_m_s = decoded->speed_m_s.value_or(0.0);
  const double gust_m_s = decoded->gust_m_s.value_or(0.0);
  const double direction_deg = decoded->direction_deg.value_or(0.0);
  require_text(speed_m_s >= 0.0 && speed_m_s <= wind::kMaxPlausibleSpeed_m_s);
  require_text(gust_m_s >= 0.0 && gust_m_s <= wind::kMaxPlausibleSpeed_m_s);
  require_text(direction_deg >= 0.0 && direction_deg < 360.0);
}

/// The line as each decoder reads it: as it is, and with a checksum that is right, so that the fields are reached.
void decode_everything(std::string_view line, unsigned choices) {
  const decode::WhenMissing checksum =
      (choices & 1U) != 0 ? decode::WhenMissing::kAccept : decode::WhenMissing::kRefuse;
  const decode::WhenMissing status = (choices & 2U) != 0 ? decode::WhenMissing::kAccept : decode::WhenMissing::kRefuse;
  constexpr std::string_view kDigits = "0123456789abcdef";
  const unsigned sum = decode::xor_checksum(line);
  const std::string digits = {kDigits[sum / 16], kDigits[sum % 16]};
  const std::string sentence = "$" + std::string(line) + "*" + digits;
  const std::string frame = '\x02' + std::string(line) + '\x03' + digits;

  decode::text::GillOptions gill;
  gill.checksum = checksum;
  gill.status = status;
  decode::text::LineOptions numbers;
  numbers.format = static_cast<decode::text::LineFormat>((choices >> 2U) % 4);
  numbers.separator = (choices & 32U) != 0 ? ' ' : ',';
  for (const std::string_view text : {line, std::string_view(sentence), std::string_view(frame)}) {
    require_physical(decode::text::decode_nmea({.checksum = checksum, .status = status, .xdr_first_id = 0}, text));
    static_cast<void>(
        decode::text::decode_nmea_quantities({.checksum = checksum, .status = status, .xdr_first_id = 0}, text));
    require_physical(decode::text::decode_gill(gill, text));
    if (const auto said = decode::text::decode_gill_quantities(gill, text)) {
      if (!said->vertical_speed_m_s || !std::isfinite(*said->vertical_speed_m_s)) std::abort();
    }
    require_physical(decode::text::decode_ft({.checksum = checksum, .status = status}, text));
    require_physical(decode::text::decode_umb({}, text));
    require_physical(decode::text::decode_wxt({.checksum = checksum}, text));
    static_cast<void>(decode::text::decode_wxt_quantities({.checksum = checksum}, text));
    require_physical(decode::text::decode_line(numbers, text));
    if (const auto read = decode::text::read_line(numbers, text)) {
      const decode::DecodedWind& wind = read->wind;
      if (wind.speed_m_s || wind.direction_deg || wind.gust_m_s) require_physical(wind);
      require_text(read->names_speed || !wind.speed_m_s);
      require_text(read->names_direction || !wind.direction_deg);
      require_text(read->names_gust || !wind.gust_m_s);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
  if (size < 2) return 0;
  const unsigned choices = data[0];
  const std::size_t piece_size = 1U + data[1];
  std::span<const std::uint8_t> rest(data + 2, size - 2);

  decode::text::LineAssembler assembler((choices & 64U) != 0 ? decode::text::LineEnding::kEtx
                                                             : decode::text::LineEnding::kNewline);
  const auto use = [&](const std::optional<decode::text::LineAssembler::Line>& line) {
    if (!line || !*line) return;
    require_text(!(*line)->empty() && (*line)->size() <= decode::text::LineAssembler::kMaxLine);
    decode_everything(**line, choices);
  };
  while (!rest.empty()) {
    std::span<const std::uint8_t> piece = rest.first(std::min(piece_size, rest.size()));
    rest = rest.subspan(piece.size());
    while (!piece.empty()) use(assembler.next(piece));
  }
  use(assembler.finish());
  return 0;
}
