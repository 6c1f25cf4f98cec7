#pragma once

#include <algorithm>
#include <cmath>

#include "daemon/tools/decode/decode_formats.hpp"
#include "daemon/tools/decode/unit_reader.hpp"

namespace yuragi::test {

/// Is a reading of `yuragi decode` what DecodedWind promises? It may be a bare count or voltage.
inline bool is_sound(const UnitReading& reading) {
  if (reading.volts && !std::isfinite(*reading.volts)) return false;
  if (reading.wind == DecodedWind{}) return reading.count || reading.volts;
  return checked(reading.wind).has_value();
}

/// Puts bytes through a format, in pieces of this size, and hands on what comes out.
template <class Use>
void decode_units(const UnitFormat& format, const UnitDecoderOptions& options, bool is_hex, ByteSpan bytes,
                  std::size_t piece, Use use) {
  using Form = UnitReader::Form;
  UnitReader reader(!is_hex ? Form::kLines : format.is_text ? Form::kHexLines : Form::kHexFrames, format.ending);
  const auto decoder = format.make(options);
  const auto message = [&](const ReadUnit& unit) {
    if (unit.why) return use(UnitDecoder::Outcome(UnitRefusal{*unit.why, {}}));
    decoder->take({unit.bytes, unit.request}, use);
  };
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(piece, bytes.size()))) {
    reader.feed(bytes.first(std::min(piece, bytes.size())), message);
  }
  reader.finish(message);
  decoder->finish(use);
}

}  // namespace yuragi::test
