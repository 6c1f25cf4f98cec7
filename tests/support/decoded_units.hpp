#pragma once

#include <algorithm>
#include <cmath>

#include "daemon/tools/decode/decode_formats.hpp"
#include "daemon/tools/decode/unit_reader.hpp"

namespace yuragi::test {

/// Is a reading of `yuragi decode` what DecodedWind promises? It may be a bare count or voltage.
inline bool is_sound(const daemon::tools::decode::UnitReading& reading) {
  if (reading.volts && !std::isfinite(*reading.volts)) return false;
  if (reading.wind == drivers::decode::DecodedWind{}) return reading.count || reading.volts;
  return drivers::decode::checked(reading.wind).has_value();
}

/// Puts bytes through a format, in pieces of this size, and hands on what comes out.
template <class Use>
void decode_units(const daemon::tools::decode::UnitFormat& format,
                  const daemon::tools::decode::UnitDecoderOptions& options, bool is_hex,
                  drivers::decode::ByteSpan bytes, std::size_t piece, Use use) {
  using Form = daemon::tools::decode::UnitReader::Form;
  daemon::tools::decode::UnitReader reader(!is_hex          ? Form::kLines
                                           : format.is_text ? Form::kHexLines
                                                            : Form::kHexFrames,
                                           format.ending, format.longest_line);
  const auto decoder = format.make(options);
  const auto message = [&](const daemon::tools::decode::ReadUnit& unit) {
    if (unit.why)
      return use(daemon::tools::decode::UnitDecoder::Outcome(daemon::tools::decode::UnitRefusal{*unit.why, {}}));
    decoder->take({unit.bytes, unit.request}, use);
  };
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(piece, bytes.size()))) {
    reader.feed(bytes.first(std::min(piece, bytes.size())), message);
  }
  reader.finish(message);
  decoder->finish(use);
}

}  // namespace yuragi::test
