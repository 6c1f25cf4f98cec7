#include "drivers/decode/hid/wmr300.hpp"

#include <algorithm>
#include <optional>

namespace yuragi::drivers::decode::hid {
namespace {

constexpr std::uint8_t kWmr300FirstData = 0xD1;
constexpr std::uint8_t kWmr300LastData = 0xDC;
constexpr std::uint8_t kWmr300History = 0xD2;
constexpr std::uint8_t kWmr300Temperature = 0xD3;
constexpr std::uint8_t kWmr300Wind = 0xD4;
constexpr std::uint8_t kWmr300Rain = 0xD5;
constexpr std::uint8_t kWmr300Pressure = 0xD6;
constexpr std::size_t kWmr300TemperaturePacket = 61;
constexpr std::size_t kWmr300RainPacket = 40;
constexpr std::size_t kWmr300PressurePacket = 46;
constexpr std::uint8_t kWmr300Outdoors = 1;
constexpr std::uint8_t kWmr300NoData = 0x7F;
constexpr double kHundredthInch_mm = 0.254;
constexpr std::size_t kWmr300Channel = 7;
constexpr std::size_t kWmr300Magic = 12;
constexpr std::size_t kWmr300SumAt = 52;

/// The number at `at`; none if the console has none.
std::optional<double> wmr300_number(ByteSpan packet, std::size_t at) {
  if (packet[at] == kWmr300NoData) return std::nullopt;
  return big_endian_16(packet, at);
}

/// The same for a number that can be negative.
std::optional<double> wmr300_signed_number(ByteSpan packet, std::size_t at) {
  if (packet[at] == kWmr300NoData) return std::nullopt;
  return static_cast<std::int16_t>(big_endian_16(packet, at));
}

std::optional<double> millimetres(std::optional<double> hundredths_inch) {
  if (!hundredths_inch) return std::nullopt;
  return *hundredths_inch * kHundredthInch_mm;
}

std::optional<double> tenths(std::optional<double> number) {
  if (!number) return std::nullopt;
  return *number / 10.0;
}

}  // namespace

Result<DecodedWind, Refusal> decode_wmr300(ByteSpan packet) noexcept {
  // Refuses packets that are not the wind's, incomplete or damaged.
  if (packet.empty()) return Refusal::kTooShort;
  if (packet[0] != kWmr300Wind) return Refusal::kNotMine;
  if (packet.size() < kWmr300WindPacket) return Refusal::kTooShort;
  if (packet[1] != kWmr300WindPacket) return Refusal::kMalformed;
  if (sum_16(packet.first(kWmr300SumAt)) != big_endian_16(packet, kWmr300SumAt)) return Refusal::kBadChecksum;

  DecodedWind wind;
  wind.gust_m_s = tenths(wmr300_number(packet, 8));
  wind.speed_m_s = tenths(wmr300_number(packet, 12));
  const auto direction_deg = wmr300_number(packet, 14);
  if (direction_deg && *direction_deg <= 360.0) {
    wind.direction_deg = wrapped_direction_deg(*direction_deg);
  } else if (direction_deg && !wind.speed_m_s) {
    return Refusal::kImplausible;
  } else if (direction_deg) {
    wind.status = DecodedStatus::kUncertain;  // the speed is still one
  }
  return checked(wind);
}

std::optional<wind::StationQuantities> decode_wmr300_quantities(ByteSpan packet) noexcept {
  if (!wants_wmr300_acknowledgement(packet) || !is_sound_wmr300(packet)) return std::nullopt;
  wind::StationQuantities said;
  if (packet[0] == kWmr300Temperature && packet[1] == kWmr300TemperaturePacket) {
    if (packet[kWmr300Channel] != kWmr300Outdoors) return std::nullopt;
    said.air_temperature_c = tenths(wmr300_signed_number(packet, 8));
    if (packet[10] != kWmr300NoData) said.relative_humidity_percent = packet[10];
    return said;
  }
  if (packet[0] == kWmr300Rain && packet[1] == kWmr300RainPacket) {
    said.rain_total_mm = millimetres(wmr300_number(packet, 15));
    said.rain_rate_mm_h = millimetres(wmr300_number(packet, 17));
    return said;
  }
  if (packet[0] == kWmr300Pressure && packet[1] == kWmr300PressurePacket) {
    said.pressure_hpa = tenths(wmr300_number(packet, 8));
    return said;
  }
  return std::nullopt;
}

bool is_wmr300_identity(ByteSpan packet) noexcept {
  constexpr std::array<std::uint8_t, 6> kName = {'W', 'M', 'R', '3', '0', '0'};
  return packet.size() > kWmr300Magic + 1 && std::equal(kName.begin(), kName.end(), packet.begin());
}

std::array<std::uint8_t, 6> encode_wmr300_begin(ByteSpan identity) noexcept {
  return {0x73, 0xE5, 0x0A, 0x26, identity[kWmr300Magic], identity[kWmr300Magic + 1]};
}

bool is_sound_wmr300(ByteSpan packet) noexcept {
  if (!wants_wmr300_acknowledgement(packet)) {
    const bool is_reply = packet.size() > 2 && packet[0] == 'A' && packet[1] == 'C' && packet[2] == 'K';
    return is_reply || is_wmr300_identity(packet);
  }
  // The history's sum has its low byte first, the others' their high byte; it is longer than a report.
  constexpr std::size_t kSum = 2;
  const std::size_t size = packet[1];
  if (size < kWmr300Channel + kSum || size > packet.size()) return false;
  const std::uint16_t sum = sum_16(packet.first(size - kSum));
  return sum ==
         (packet[0] == kWmr300History ? little_endian_16(packet, size - kSum) : big_endian_16(packet, size - kSum));
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

}  // namespace yuragi::drivers::decode::hid
