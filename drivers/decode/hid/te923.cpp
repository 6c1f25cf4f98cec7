#include "drivers/decode/hid/te923.hpp"

#include <optional>

#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::hid {
namespace {

constexpr std::uint8_t kTe923Header = 0x5A;
constexpr std::uint8_t kTe923Read = 0x05;
constexpr std::uint8_t kTe923Acknowledge = 0x24;
constexpr double kTe923Tip_mm = 25.4 / 36.0;

std::array<std::uint8_t, 8> te923_command(std::uint8_t command, std::uint32_t address) {
  const auto byte = [address](unsigned shift) { return static_cast<std::uint8_t>((address >> shift) & 0xFFU); };
  std::array<std::uint8_t, 8> report = {command, 0xAF, byte(0), byte(8), byte(16), 0, 0, 0};
  report[5] = xor_8(ByteSpan(report).subspan(1, 4));
  return report;
}

/// The speed at `at`; none if the digits are the mark for no sensor or no digits.
std::optional<double> te923_speed_m_s(ByteSpan block, std::size_t at) {
  const unsigned ones = block[at] >> 4U;
  const unsigned tenths = block[at] & 0x0FU;
  const unsigned tens = block[at + 1] & 0x0FU;
  const unsigned hundreds = (block[at + 1] >> 4U) & 1U;
  if (ones > 9 || tenths > 9 || tens > 9) return std::nullopt;
  return (1000 * hundreds + 100 * tens + 10 * ones + tenths) / 10.0 * kMetresPerSecondPerMph;
}

/// Why no block can be in these bytes.
std::optional<Refusal> te923_refusal(ByteSpan block) {
  if (block.empty()) return Refusal::kTooShort;
  if (block[0] != kTe923Header) return Refusal::kMalformed;
  if (block.size() < kTe923Block) return Refusal::kTooShort;
  if (block.size() > kTe923Block) return Refusal::kMalformed;
  if (xor_8(block) != 0) return Refusal::kBadChecksum;  // the sum with its own check byte
  return std::nullopt;
}

/// The temperature at `at`; none if a digit is none, or the block marks it as invalid.
std::optional<double> te923_temperature_c(ByteSpan block, std::size_t at) {
  constexpr unsigned kHalfTenth = 0x20;
  constexpr unsigned kIsValid = 0x40;
  constexpr unsigned kIsNotNegative = 0x80;
  const unsigned ones = block[at] >> 4U;
  const unsigned tenths = block[at] & 0x0FU;
  const unsigned second = block[at + 1];
  const unsigned tens = second & 0x0FU;
  if (ones > 9 || tenths > 9 || tens > 9 || (second & kIsValid) == 0) return std::nullopt;
  const unsigned hundredths = 1000 * tens + 100 * ones + 10 * tenths + ((second & kHalfTenth) != 0 ? 5 : 0);
  const double size_c = hundredths / 100.0;
  return (second & kIsNotNegative) != 0 ? size_c : -size_c;
}

}  // namespace

std::array<std::uint8_t, 8> encode_te923_request(std::uint32_t address) noexcept {
  return te923_command(kTe923Read, address);
}

std::array<std::uint8_t, 8> encode_te923_acknowledgement(std::uint32_t address) noexcept {
  return te923_command(kTe923Acknowledge, address);
}

Result<DecodedWind, Refusal> decode_te923(ByteSpan block) noexcept {
  if (const auto refusal = te923_refusal(block)) return *refusal;

  DecodedWind wind;
  wind.speed_m_s = te923_speed_m_s(block, 28);
  if (!wind.speed_m_s) return Refusal::kInvalid;
  wind.gust_m_s = te923_speed_m_s(block, 26);
  wind.direction_deg = (block[30] & 0x0FU) * 22.5;
  return checked(wind);
}

std::optional<wind::StationQuantities> decode_te923_quantities(ByteSpan block) noexcept {
  if (te923_refusal(block)) return std::nullopt;
  wind::StationQuantities said;
  said.air_temperature_c = te923_temperature_c(block, 4);
  const unsigned tens = block[6] >> 4U;
  const unsigned ones = block[6] & 0x0FU;
  if (tens <= 9 && ones <= 9) said.relative_humidity_percent = 10.0 * tens + ones;
  if (block[22] >> 4U != 0x0F) said.pressure_hpa = little_endian_16(block, 21) / 16.0;
  said.rain_total_mm = little_endian_16(block, 31) * kTe923Tip_mm;
  return said;
}

}  // namespace yuragi::drivers::decode::hid
