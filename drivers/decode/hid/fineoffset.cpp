#include "drivers/decode/hid/fineoffset.hpp"

#include <algorithm>
#include <optional>

namespace yuragi::drivers::decode::hid {
namespace {

constexpr std::array<std::uint16_t, 7> kFineOffsetMarks = {0x55AA, 0xFFFF, 0x5555, 0xC400, 0x44BF, 0x0001, 0x001E};
constexpr std::size_t kMinRecord = 16;
constexpr std::uint32_t kMemoryEnd = 0x10000;
constexpr unsigned kNoSpeed = 0xFFF;
constexpr unsigned kNoDirection = 0x80;
constexpr unsigned kNoContact = 0x40;

std::optional<double> fineoffset_speed_m_s(unsigned low, unsigned high) {
  const unsigned tenths = (high << 8U) | low;
  if (tenths == kNoSpeed) return std::nullopt;
  return tenths / 10.0;
}

constexpr double kRainOfATip_mm = 0.3;
constexpr unsigned kNoWord = 0xFFFF;
constexpr unsigned kNoHumidity = 0xFF;

/// Tenths, of which the top bit is the sign.
std::optional<double> signed_tenths(unsigned word) {
  if (word == kNoWord) return std::nullopt;
  const double size = (word & 0x7FFFU) / 10.0;
  return (word & 0x8000U) != 0 ? -size : size;
}

/// Why no record can be in these bytes.
std::optional<Refusal> record_refusal(ByteSpan record) {
  if (record.size() < kMinRecord) return Refusal::kTooShort;
  if (record.size() > kFineOffsetBlock) return Refusal::kMalformed;
  const bool is_blank = std::ranges::all_of(record, [](std::uint8_t byte) { return byte == 0; });
  if (is_blank) return Refusal::kMalformed;
  return std::nullopt;
}

bool is_fineoffset_position(std::uint32_t position, std::uint32_t length) {
  return position >= kFineOffsetFirstRecord && (position - kFineOffsetFirstRecord) % length == 0 &&
         position + length <= kMemoryEnd;
}

}  // namespace

std::array<std::uint8_t, 8> encode_fineoffset_read(std::uint16_t address) noexcept {
  const auto high = static_cast<std::uint8_t>(address >> 8U);
  const auto low = static_cast<std::uint8_t>(address & 0xFFU);
  return {0xA1, high, low, 0x20, 0xA1, high, low, 0x20};
}

Result<FineOffsetFixedBlock, Refusal> decode_fineoffset_fixed_block(ByteSpan block, FineOffsetModel model) noexcept {
  if (block.size() < kFineOffsetBlock) return Refusal::kTooShort;
  if (std::ranges::find(kFineOffsetMarks, big_endian_16(block, 0)) == kFineOffsetMarks.end()) {
    return Refusal::kMalformed;
  }
  const FineOffsetFixedBlock fixed = {.read_period_min = block[16],
                                      .record_count = little_endian_16(block, 27),
                                      .current_position = little_endian_16(block, 30)};
  if (!is_fineoffset_position(fixed.current_position, static_cast<std::uint32_t>(model))) return Refusal::kImplausible;
  return fixed;
}

Result<DecodedWind, Refusal> decode_fineoffset_record(ByteSpan record) noexcept {
  if (const auto refusal = record_refusal(record)) return *refusal;
  if ((record[15] & kNoContact) != 0) return Refusal::kInvalid;

  DecodedWind wind;
  wind.speed_m_s = fineoffset_speed_m_s(record[9], record[11] & 0x0FU);
  wind.gust_m_s = fineoffset_speed_m_s(record[10], record[11] >> 4U);
  if ((record[12] & kNoDirection) == 0) {
    if (record[12] < 16) {
      wind.direction_deg = record[12] * 22.5;
    } else {
      wind.status = DecodedStatus::kUncertain;
    }
  }
  return checked(wind);
}

std::optional<wind::StationQuantities> decode_fineoffset_quantities(ByteSpan record) noexcept {
  if (record_refusal(record)) return std::nullopt;
  wind::StationQuantities said;
  if (const unsigned pressure = little_endian_16(record, 7); pressure != kNoWord) said.pressure_hpa = pressure / 10.0;
  if ((record[15] & kNoContact) != 0) return said;
  if (record[4] != kNoHumidity) said.relative_humidity_percent = record[4];
  said.air_temperature_c = signed_tenths(little_endian_16(record, 5));
  said.rain_total_mm = little_endian_16(record, 13) * kRainOfATip_mm;
  return said;
}

}  // namespace yuragi::drivers::decode::hid
