#include "drivers/decode/wmr300.hpp"

#include <optional>

namespace yuragi {
namespace {

constexpr std::uint8_t kWmr300FirstData = 0xD1;
constexpr std::uint8_t kWmr300LastData = 0xDC;
constexpr std::uint8_t kWmr300Wind = 0xD4;
constexpr std::size_t kWmr300Channel = 7;
constexpr std::size_t kWmr300SumAt = 52;

/// The number at `at`; none where the console has none.
std::optional<double> wmr300_number(ByteSpan packet, std::size_t at) {
  if (packet[at] == 0x7F) return std::nullopt;
  return big_endian_16(packet, at);
}

std::optional<double> tenths(std::optional<double> number) {
  if (!number) return std::nullopt;
  return *number / 10.0;
}

}  // namespace

Result<DecodedWind, Refusal> decode_wmr300(ByteSpan packet) noexcept {
  // The wind's, whole and undamaged?
  if (packet.empty()) return Refusal::kTooShort;
  if (packet[0] != kWmr300Wind) return Refusal::kNotMine;
  if (packet.size() < kWmr300WindPacket) return Refusal::kTooShort;
  if (packet[1] != kWmr300WindPacket) return Refusal::kMalformed;
  if (sum_16(packet.first(kWmr300SumAt)) != big_endian_16(packet, kWmr300SumAt)) return Refusal::kBadChecksum;

  DecodedWind wind;
  wind.gust_m_s = tenths(wmr300_number(packet, 8));
  wind.speed_m_s = tenths(wmr300_number(packet, 12));
  const auto direction_deg = wmr300_number(packet, 14);
  if (direction_deg && *direction_deg > 360.0) return Refusal::kImplausible;
  if (direction_deg) wind.direction_deg = wrapped_direction_deg(*direction_deg);
  return checked(wind);
}

bool wants_wmr300_acknowledgement(ByteSpan packet) noexcept {
  return packet.size() > kWmr300Channel && packet[0] >= kWmr300FirstData && packet[0] <= kWmr300LastData;
}

std::array<std::uint8_t, 6> encode_wmr300_acknowledgement(ByteSpan packet) noexcept {
  const bool has_channel = wants_wmr300_acknowledgement(packet);
  const std::uint8_t kind = has_channel ? packet[0] : kWmr300Wind;
  const std::uint8_t channel = has_channel ? packet[kWmr300Channel] : std::uint8_t{0};
  return {'A', 'C', 'K', kind, channel, 0};
}

}  // namespace yuragi
