// Any bytes, in any pieces with any pauses, silences and losses between them, through the drivers of text: what they
// publish is physical, and whatever comes, they ask to be polled again within bounds.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "engine/wind/wind_reading.hpp"
#include "tests/support/scripted_text.hpp"

namespace {

using namespace yuragi;

void require_holds(bool holds) {
  if (!holds) std::abort();
}

/// The driver that a choice makes: each format, each policy, each kind of port.
void make(ScriptedText& text, unsigned choices) {
  ParameterValues::Map given;
  given["transport"] = std::string((choices & 2U) != 0 ? "udp" : "serial");
  if ((choices & 1U) != 0) {
    text.make_line(given);
    return;
  }
  given["missing_checksum"] = std::string((choices & 4U) != 0 ? "accept" : "refuse");
  given["format"] = std::string((choices & 8U) != 0 ? "gill" : (choices & 16U) != 0 ? "umb" : "auto");
  text.make_nmea(given);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
  if (size < 2) return 0;
  ScriptedText text;
  make(text, data[0]);

  // A byte says how many follow in one piece, or how long nothing does, or that the port is lost.
  constexpr std::uint8_t kLongest = 200;
  for (std::size_t at = 1; at < size;) {
    const std::uint8_t how = data[at++];
    if (how == 255) {
      text.far_end.incoming.push_back({drivers::bus::ByteStatus::kLost, "", false});
    } else if (how > kLongest) {
      text.run(std::chrono::milliseconds(100) * (how - kLongest));
    } else {
      const std::size_t length = std::min<std::size_t>(how, size - at);
      if (length > 0) {
        const std::string piece(reinterpret_cast<const char*>(data + at), length);
        text.far_end.incoming.push_back({drivers::bus::ByteStatus::kBytes, piece, how % 2 == 0});
      }
      at += length;
    }
    if (text.far_end.incoming.size() > 16) text.run(std::chrono::seconds(20));
  }
  text.run(std::chrono::minutes(1));

  for (const wind::Reading& reading : text.sink.readings) require_holds(wind::is_plausible(reading));
  return 0;
}
