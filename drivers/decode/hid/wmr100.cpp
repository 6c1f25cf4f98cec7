#include "drivers/decode/hid/wmr100.hpp"

#include <algorithm>

namespace yuragi::drivers::decode::hid {
namespace {

constexpr std::uint8_t kWmr100Wind = 0x48;
constexpr std::size_t kWmr100WindFrame = 11;
constexpr std::size_t kWmr100Sum = 2;
constexpr std::uint8_t kWmr100Separator = 0xFF;

bool is_whole_wind_frame(const Wmr100Stream& stream) {
  return stream.size == kWmr100WindFrame && stream.frame[1] == kWmr100Wind;
}

/// What has been collected, as a frame; the stream then waits for the next ff ff.
Result<DecodedWind, Refusal> end_frame(Wmr100Stream& stream) {
  const auto decoded = decode_wmr100_frame(ByteSpan(stream.frame).first(stream.size));
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
  std::optional<Result<DecodedWind, Refusal>> ended;
  if (stream.size > 0) ended = end_frame(stream);
  stream = {};
  return ended;
}

Result<DecodedWind, Refusal> decode_wmr100_frame(ByteSpan frame) noexcept {
  // Whole, undamaged, and the wind's?
  if (frame.size() < 2 + kWmr100Sum) return Refusal::kTooShort;
  if (frame[1] == kWmr100Wind && frame.size() < kWmr100WindFrame) return Refusal::kTooShort;
  const std::size_t body = frame.size() - kWmr100Sum;
  if (sum_16(frame.first(body)) != little_endian_16(frame, body)) return Refusal::kBadChecksum;
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

}  // namespace yuragi::drivers::decode::hid
