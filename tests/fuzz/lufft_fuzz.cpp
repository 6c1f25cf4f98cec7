// Any bytes for the decoder of Lufft's UMB protocol, with checksums mended on request, so that values are reached; and
// for the driver, in any pieces with any pauses between them: what it publishes is physical.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "drivers/decode/lufft/umb.hpp"
#include "drivers/decode/lufft/umb_assembler.hpp"
#include "drivers/lufft/umb_sensor.hpp"
#include "engine/wind/wind_reading.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/scripted_port.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

void require(bool holds) {
  if (!holds) std::abort();
}

void read_frame(decode::ByteSpan frame) {
  const auto reply = decode::lufft::decode_umb_reply({}, frame);
  if (!reply) return;
  require(reply->count <= decode::lufft::kMaxUmbChannels);
  const auto wind = decode::lufft::wind_of(*reply);
  require(!wind || decode::checked(*wind).has_value());
  static_cast<void>(wind::plausible_part(decode::lufft::quantities_of(*reply)));
}

/// The bytes as what a reply says.
std::vector<std::uint8_t> mended_frame(decode::ByteSpan text) {
  text = text.first(std::min<std::size_t>(text.size(), 209));
  std::vector<std::uint8_t> frame = {0x01, 0x10, 0x01, 0xF0, 0x01, 0x70, static_cast<std::uint8_t>(text.size() + 3),
                                     0x02, 0x2F, 0x10, 0x00};
  frame.insert(frame.end(), text.begin(), text.end());
  frame.push_back(0x03);
  const std::uint16_t sum = decode::lufft::umb_checksum(frame);
  frame.insert(frame.end(), {static_cast<std::uint8_t>(sum & 0xFFU), static_cast<std::uint8_t>(sum >> 8U), 0x04});
  return frame;
}

void assemble(decode::ByteSpan bytes) {
  decode::lufft::UmbAssembler assembler;
  while (const auto frame = assembler.next(bytes)) {
    if (*frame) read_frame(**frame);
  }
  require(bytes.empty());
  static_cast<void>(assembler.cut());
  require(!assembler.cut());
}

void talk(decode::ByteSpan bytes) {
  FarEnd far_end;
  ManualClock clock;
  RecordingSink sink;
  lufft::UmbSettings settings;
  settings.address.path = "/dev/script";
  settings.device = decode::lufft::umb_address(7, 1);
  settings.poll_interval = std::chrono::seconds(1);
  settings.response_timeout = std::chrono::milliseconds(500);
  lufft::UmbSensor sensor(settings, std::make_unique<ScriptedPort>(far_end, clock));
  // Each request takes the next piece: a byte says how long it is, and whether it is a whole reply.
  far_end.on_request = [&](const std::string&) {
    if (bytes.empty()) return;
    const std::uint8_t how = bytes[0];
    const decode::ByteSpan piece = bytes.subspan(1, std::min<std::size_t>(how / 2U, bytes.size() - 1));
    bytes = bytes.subspan(1 + piece.size());
    const std::vector<std::uint8_t> sent =
        how % 2 == 0 ? mended_frame(piece) : std::vector<std::uint8_t>(piece.begin(), piece.end());
    if (!sent.empty()) far_end.send({reinterpret_cast<const char*>(sent.data()), sent.size()});
  };
  const MonoTime end = clock.now().mono + std::chrono::seconds(60);
  for (int i = 0; clock.now().mono < end && i < 10'000; ++i) clock.advance_to(sensor.poll(clock, sink));
  for (const wind::Reading& reading : sink.readings) require(wind::is_plausible(reading));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
  const decode::ByteSpan bytes(data, size);
  read_frame(bytes);
  read_frame(mended_frame(bytes));
  assemble(bytes);
  talk(bytes);
  return 0;
}
