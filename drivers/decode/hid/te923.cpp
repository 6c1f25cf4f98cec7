#include "drivers/decode/hid/te923.hpp"

#include <optional>

#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::hid {
namespace {

constexpr std::uint8_t kTe923Header = 0x5A;
constexpr std::uint8_t kTe923Read = 0x05;
constexpr std::uint8_t kTe923Acknowledge = 0x24;

std::array<std::uint8_t, 8> te923_command(std::uint8_t command, std::uint32_t address) {
  const auto byte = [address](unsigned shift) { return static_cast<std::uint8_t>((address >> shift) & 0xFFU); };
  std::array<std::uint8_t, 8> report = {command, 0xAF, byte(0), byte(8), byte(16), 0, 0, 0};
  report[5] = xor_8(ByteSpan(report).subspan(1, 4));
  return report;
}

/// The speed at `at`; none where the digits are the mark for no sensor or no digits.
std::optional<double> te923_speed_m_s(ByteSpan block, std::size_t at) {
  const unsigned ones = block[at] >> 4U;
  const unsigned tenths = block[at] & 0x0FU;
  const unsigned tens = block[at + 1] & 0x0FU;
  const unsigned hundreds = (block[at + 1] >> 4U) & 1U;
  if (ones > 9 || tenths > 9 || tens > 9) return std::nullopt;
  return (1000 * hundreds + 100 * tens + 10 * ones + tenths) / 10.0 * kMetresPerSecondPerMph;
}

}  // namespace

std::array<std::uint8_t, 8> encode_te923_request(std::uint32_t address) noexcept {
  return te923_command(kTe923Read, address);
}

std::array<std::uint8_t, 8> encode_te923_acknowledgement(std::uint32_t address) noexcept {
  return te923_command(kTe923Acknowledge, address);
}

Result<DecodedWind, Refusal> decode_te923(ByteSpan block) noexcept {
  if (block.empty()) return Refusal::kTooShort;
  if (block[0] != kTe923Header) return Refusal::kMalformed;
  if (block.size() < kTe923Block) return Refusal::kTooShort;
  if (block.size() > kTe923Block) return Refusal::kMalformed;
  if (xor_8(block) != 0) return Refusal::kBadChecksum;  // the sum with its own check byte

  DecodedWind wind;
  wind.speed_m_s = te923_speed_m_s(block, 28);
  if (!wind.speed_m_s) return Refusal::kInvalid;
  wind.gust_m_s = te923_speed_m_s(block, 26);
  wind.direction_deg = (block[30] & 0x0FU) * 22.5;
  return checked(wind);
}

}  // namespace yuragi::drivers::decode::hid
