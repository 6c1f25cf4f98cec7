// Any bytes for the decoders of the WeatherLink Live and of Davis consoles, with checksums mended on request, so that
// values are reached; and for the driver, in any pieces with any pauses between them: what it publishes is physical.
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "drivers/davis/vantage_sensor.hpp"
#include "drivers/decode/davis/vantage.hpp"
#include "drivers/decode/davis/vantage_assembler.hpp"
#include "drivers/decode/davis/weatherlink_live.hpp"
#include "engine/wind/wind_reading.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/scripted_port.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;
using decode::davis::kVantagePacket;

void require(bool holds) {
  if (!holds) std::abort();
}

void read_packet(decode::ByteSpan bytes) {
  const auto decoded = decode::davis::decode_vantage_packet(bytes);
  require(!decoded || decode::checked(*decoded).has_value());
  static_cast<void>(decode::davis::decode_vantage_quantities(bytes, 0.2));
  static_cast<void>(decode::davis::decode_vantage_rain_of_a_tip_mm(bytes));
}

void read_mended_packet(std::vector<std::uint8_t> packet) {
  if (packet.size() < kVantagePacket) return;
  packet.resize(kVantagePacket);
  packet[0] = 'L';
  packet[1] = packet[2] = 'O';
  packet[4] &= 1U;
  packet[95] = '\n';
  packet[96] = '\r';
  const std::uint16_t sum = decode::davis::vantage_checksum(decode::ByteSpan(packet).first(97));
  packet[97] = static_cast<std::uint8_t>(sum >> 8U);
  packet[98] = static_cast<std::uint8_t>(sum & 0xFFU);
  const auto decoded = decode::davis::decode_vantage_packet(packet);
  require(decoded || decoded.error() == decode::Refusal::kInvalid);
  read_packet(packet);
}

void assemble(decode::ByteSpan bytes) {
  decode::davis::VantageAssembler assembler;
  while (const auto packet = assembler.next(bytes)) {
    if (*packet) require(decode::davis::vantage_checksum(**packet) == 0);
  }
  require(bytes.empty());
  static_cast<void>(assembler.cut());
  require(!assembler.cut());
}

void read_json(std::string_view json) {
  for (const int transmitter : {0, 1}) {
    const auto said = decode::davis::decode_live_conditions(json, transmitter);
    require(!said || decode::checked(said->wind).has_value());
  }
  const auto port = decode::davis::decode_live_broadcast_port(json);
  require(!port || *port > 0);
}

void talk(const std::uint8_t* data, std::size_t size) {
  FarEnd far_end;
  ManualClock clock;
  RecordingSink sink;
  davis::VantageSettings settings;
  settings.address.path = "/dev/script";
  davis::VantageSensor sensor(settings, std::make_unique<ScriptedPort>(far_end, clock));
  // The beginning of the dialogue, so that packets are reached.
  far_end.on_request = [&far_end](const std::string& request) { far_end.send(request == "\n" ? "\n\r" : "\x06"); };
  const auto run = [&](Nanoseconds duration) {
    const MonoTime end = clock.now().mono + duration;
    for (int idle = 0; clock.now().mono < end && idle < 10'000; ++idle) clock.advance_to(sensor.poll(clock, sink));
  };
  run(std::chrono::seconds(5));
  // A byte says how many follow in one piece, or how long nothing does, or that the port is lost.
  constexpr std::uint8_t kLongest = 200;
  for (std::size_t at = 0; at < size;) {
    const std::uint8_t how = data[at++];
    if (how == 255) {
      far_end.incoming.push_back({bus::ByteStatus::kLost, "", false});
    } else if (how > kLongest) {
      run(std::chrono::milliseconds(100) * (how - kLongest));
    } else {
      const std::size_t length = std::min<std::size_t>(how, size - at);
      if (length > 0) far_end.send({reinterpret_cast<const char*>(data + at), length});
      at += length;
    }
    if (far_end.incoming.size() > 16) run(std::chrono::seconds(20));
  }
  run(std::chrono::seconds(30));
  for (const wind::Reading& reading : sink.readings) require(wind::is_plausible(reading));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
  const decode::ByteSpan bytes(data, size);
  read_packet(bytes);
  read_mended_packet({bytes.begin(), bytes.end()});
  assemble(bytes);
  read_json({reinterpret_cast<const char*>(data), size});
  talk(data, size);
  return 0;
}
