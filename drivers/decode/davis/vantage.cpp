#include "drivers/decode/davis/vantage.hpp"

#include <algorithm>
#include <array>

#include "engine/base/units.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::decode::davis {
namespace {

constexpr double kHpaInInchOfMercury = 33.86389;
constexpr std::array<std::uint8_t, 3> kVantageMark = {'L', 'O', 'O'};
constexpr std::uint8_t kLoop2 = 1;
constexpr unsigned kNoVantageByte = 0xFF;
constexpr unsigned kNoVantageWord = 0xFFFF;
constexpr unsigned kNoSignedWord = 0x7FFF;
constexpr std::array<double, 3> kRainOfTips_mm = {0.254, 0.2, 0.1};

bool is_valid_value(unsigned word) {
  return word != kNoVantageWord && word != kNoSignedWord;
}

/// Why no packet can be in these bytes.
std::optional<Refusal> packet_refusal(ByteSpan packet) {
  if (packet.size() < kVantagePacket) return Refusal::kTooShort;
  const bool has_shape =
      packet.size() == kVantagePacket && begins_vantage_packet(packet) && packet[95] == '\n' && packet[96] == '\r';
  if (!has_shape) return Refusal::kMalformed;
  if (vantage_checksum(packet) != 0) return Refusal::kBadChecksum;
  return std::nullopt;
}

/// The gust of a LOOP2, unless it is impossible or below the average of the same ten minutes.
std::optional<double> gust_of_loop2_m_s(ByteSpan packet) {
  const unsigned gust_mph = little_endian_16(packet, 22);
  const unsigned average_tenths_mph = little_endian_16(packet, 18);
  if (!is_valid_value(gust_mph) || gust_mph == kNoVantageByte) return std::nullopt;
  if (is_valid_value(average_tenths_mph) && 10 * gust_mph < average_tenths_mph) return std::nullopt;
  const double gust_m_s = gust_mph * kMetresPerSecondPerMph;
  return gust_m_s <= wind::kMaxPlausibleSpeed_m_s ? std::optional(gust_m_s) : std::nullopt;
}

std::optional<double> rain_mm(unsigned tips, std::optional<double> rain_of_a_tip_mm) {
  if (tips == kNoVantageWord || !rain_of_a_tip_mm) return std::nullopt;
  return tips * *rain_of_a_tip_mm;
}

}  // namespace

std::uint16_t vantage_checksum(ByteSpan bytes) noexcept {
  unsigned sum = 0;
  for (const std::uint8_t byte : bytes) {
    sum ^= static_cast<unsigned>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) sum = (sum & 0x8000U) != 0 ? (sum << 1U) ^ 0x1021U : sum << 1U;
  }
  return static_cast<std::uint16_t>(sum & 0xFFFFU);
}

bool begins_vantage_packet(ByteSpan beginning) noexcept {
  const std::size_t known = std::min(beginning.size(), kVantageMark.size());
  if (!std::ranges::equal(beginning.first(known), ByteSpan(kVantageMark).first(known))) return false;
  return beginning.size() <= 4 || beginning[4] <= kLoop2;
}

Result<DecodedWind, Refusal> decode_vantage_packet(ByteSpan packet) noexcept {
  if (const auto refusal = packet_refusal(packet)) return *refusal;
  const unsigned speed_mph = packet[14];
  const unsigned direction_deg = little_endian_16(packet, 16);
  const bool has_direction = direction_deg != 0 && is_valid_value(direction_deg);
  if (speed_mph == kNoVantageByte || (speed_mph == 0 && !has_direction)) return Refusal::kInvalid;

  DecodedWind wind;
  wind.speed_m_s = speed_mph * kMetresPerSecondPerMph;
  wind.reference = WindReference::kNorth;
  if (has_direction && direction_deg <= 360) {
    wind.direction_deg = wrapped_direction_deg(direction_deg);
  } else if (has_direction) {
    wind.status = DecodedStatus::kUncertain;
  }
  if (packet[4] == kLoop2) wind.gust_m_s = gust_of_loop2_m_s(packet);
  return checked(wind);
}

std::optional<wind::StationQuantities> decode_vantage_quantities(ByteSpan packet,
                                                                 std::optional<double> rain_of_a_tip_mm) noexcept {
  if (packet_refusal(packet)) return std::nullopt;
  wind::StationQuantities said;
  if (const unsigned pressure = little_endian_16(packet, 7); pressure != 0 && is_valid_value(pressure)) {
    said.pressure_hpa = pressure / 1000.0 * kHpaInInchOfMercury;
  }
  if (const unsigned temperature = little_endian_16(packet, 12); is_valid_value(temperature)) {
    said.air_temperature_c = (static_cast<std::int16_t>(temperature) / 10.0 - 32.0) / 1.8;
  }
  if (packet[33] != kNoVantageByte) said.relative_humidity_percent = packet[33];
  said.rain_rate_mm_h = rain_mm(little_endian_16(packet, 41), rain_of_a_tip_mm);
  said.rain_total_mm = rain_mm(little_endian_16(packet, 50), rain_of_a_tip_mm);
  return said;
}

Result<double, Refusal> decode_vantage_rain_of_a_tip_mm(ByteSpan reply) noexcept {
  if (reply.size() < 3) return Refusal::kTooShort;
  if (reply.size() > 3) return Refusal::kMalformed;
  if (vantage_checksum(reply) != 0) return Refusal::kBadChecksum;
  const unsigned collector = (reply[0] >> 4U) & 3U;
  if (collector >= kRainOfTips_mm.size()) return Refusal::kInvalid;
  return kRainOfTips_mm[collector];
}

}  // namespace yuragi::drivers::decode::davis
