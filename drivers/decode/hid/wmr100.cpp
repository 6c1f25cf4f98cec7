#include "drivers/decode/hid/wmr100.hpp"

#include <algorithm>

namespace yuragi::drivers::decode::hid {
namespace {

constexpr std::uint8_t kWmr100Rain = 0x41;
constexpr std::uint8_t kWmr100Temperature = 0x42;
constexpr std::uint8_t kWmr100Pressure = 0x46;
constexpr std::uint8_t kWmr100Wind = 0x48;
constexpr std::size_t kWmr100RainFrame = 17;
constexpr std::size_t kWmr100TemperatureFrame = 12;
constexpr std::size_t kWmr100PressureFrame = 8;
constexpr std::size_t kWmr100WindFrame = 11;
constexpr std::size_t kWmr100Sum = 2;
constexpr unsigned kWmr100Outdoors = 1;
constexpr double kMillimetresPerHundredthInch = 0.254;
constexpr std::uint8_t kWmr100Separator = 0xFF;

/// Returns true if the last two bytes are the sum of those before. The frame has at least two bytes.
bool has_right_sum(ByteSpan frame) {
  const std::size_t body = frame.size() - kWmr100Sum;
  return sum_16(frame.first(body)) == little_endian_16(frame, body);
}

bool is_whole_wind_frame(const Wmr100Stream& stream) {
  return stream.size == kWmr100WindFrame && stream.frame[1] == kWmr100Wind;
}

/// Ends the frame that was collected; the stream then waits for the next ff ff.
Result<DecodedWind, Refusal> end_frame(Wmr100Stream& stream) {
  const auto decoded = decode_wmr100_frame(ByteSpan(stream.frame).first(stream.size));
  stream.ended_size = stream.size;
  stream.size = 0;
  stream.is_skipping = true;
  return decoded;
}

}  // namespace

ByteSpan wmr100_report_bytes(ByteSpan report) noexcept {
  if (report.empty()) return {};
  const std::size_t count = std::min({std::size_t{report[0]}, report.size() - 1, std::size_t{7}});
  return report.subspan(1, count);
}

std::optional<Result<DecodedWind, Refusal>> take_wmr100_byte(Wmr100Stream& stream, std::uint8_t byte) noexcept {
  stream.ended_size = 0;
  // The second ff: the first one was no data either. More of them are still the same gap.
  if (byte == kWmr100Separator && stream.was_ff) {
    if (stream.size > 0) --stream.size;
    std::optional<Result<DecodedWind, Refusal>> ended;
    if (stream.size > 0) ended = end_frame(stream);
    stream.size = 0;
    stream.is_skipping = false;
    return ended;
  }

  const bool would_begin_with_ff = stream.size == 0 && byte == kWmr100Separator;
  stream.was_ff = byte == kWmr100Separator;
  if (stream.is_skipping || would_begin_with_ff) return std::nullopt;  // no frame begins with ff
  if (stream.size == stream.frame.size()) {
    stream.size = 0;
    stream.is_skipping = true;
    return Result<DecodedWind, Refusal>(Refusal::kMalformed);
  }
  stream.frame[stream.size++] = byte;
  if (is_whole_wind_frame(stream)) return end_frame(stream);
  return std::nullopt;
}

std::optional<Result<DecodedWind, Refusal>> finish_wmr100(Wmr100Stream& stream) noexcept {
  stream.ended_size = 0;
  std::optional<Result<DecodedWind, Refusal>> ended;
  if (stream.size > 0) ended = end_frame(stream);
  stream.is_skipping = false;
  stream.was_ff = false;
  return ended;
}

ByteSpan ended_wmr100_frame(const Wmr100Stream& stream) noexcept {
  return ByteSpan(stream.frame).first(stream.ended_size);
}

Result<DecodedWind, Refusal> decode_wmr100_frame(ByteSpan frame) noexcept {
  // Refuses frames that are incomplete, damaged, or not the wind's.
  if (frame.size() < 2 + kWmr100Sum) return Refusal::kTooShort;
  if (frame[1] == kWmr100Wind && frame.size() < kWmr100WindFrame) return Refusal::kTooShort;
  if (!has_right_sum(frame)) return Refusal::kBadChecksum;
  if (frame[1] != kWmr100Wind) return Refusal::kNotMine;
  if (frame.size() > kWmr100WindFrame) return Refusal::kMalformed;

  const unsigned gust = ((frame[5] & 0x0FU) << 8U) | frame[4];
  const unsigned average = (static_cast<unsigned>(frame[6]) << 4U) | (frame[5] >> 4U);
  DecodedWind wind;
  wind.speed_m_s = average / 10.0;
  wind.direction_deg = (frame[2] & 0x0FU) * 22.5;
  wind.gust_m_s = gust / 10.0;
  if ((frame[0] & 0xF0U) != 0) wind.status = DecodedStatus::kUncertain;
  return checked(wind);
}

std::optional<wind::StationQuantities> decode_wmr100_quantities(ByteSpan frame) noexcept {
  if (frame.size() < 2 + kWmr100Sum || !has_right_sum(frame)) return std::nullopt;
  wind::StationQuantities said;
  if (frame[1] == kWmr100Rain && frame.size() == kWmr100RainFrame) {
    said.rain_total_mm = little_endian_16(frame, 8) * kMillimetresPerHundredthInch;
    return said;
  }
  if (frame[1] == kWmr100Pressure && frame.size() == kWmr100PressureFrame) {
    said.pressure_hpa = little_endian_16(frame, 2) & 0x0FFFU;
    return said;
  }
  const bool is_temperature = frame[1] == kWmr100Temperature && frame.size() == kWmr100TemperatureFrame;
  if (!is_temperature || (frame[2] & 0x0FU) != kWmr100Outdoors) return std::nullopt;
  const unsigned word = little_endian_16(frame, 3);
  const double size_c = (word & 0x7FFFU) / 10.0;
  said.air_temperature_c = (word & 0x8000U) != 0 ? -size_c : size_c;
  said.relative_humidity_percent = frame[5];
  return said;
}

}  // namespace yuragi::drivers::decode::hid
