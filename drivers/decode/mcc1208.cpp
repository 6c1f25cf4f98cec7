#include "drivers/decode/mcc1208.hpp"

namespace yuragi {
namespace {

constexpr std::size_t kMcc1208Counter = 4;
constexpr std::size_t kMcc1208Analog = 2;
constexpr std::uint16_t kMcc1208Steps = 4096;

/// What the eight bipolar ranges reach to either side, in the order of Mcc1208Range.
constexpr std::array<double, 8> kMcc1208FullScale_v = {20.0, 10.0, 5.0, 4.0, 2.5, 2.0, 1.25, 1.0};

}  // namespace

Mcc1208Transfer mcc1208_read_analog(std::uint8_t channel, bool is_differential, Mcc1208Range range) noexcept {
  const unsigned mode = is_differential ? 1 : 0;
  return {.request_type = 0xC0,
          .request = 0x10,
          .value = static_cast<std::uint16_t>((mode << 8U) | channel),
          .index = static_cast<std::uint16_t>(range),
          .length = kMcc1208Analog};
}

Result<Mcc1208Reply, Refusal> decode_mcc1208(ByteSpan reply) noexcept {
  Mcc1208Reply decoded;
  switch (reply.size()) {
    case kMcc1208Counter:
      decoded.count = little_endian_32(reply, 0);
      return decoded;
    case kMcc1208Analog:
      decoded.analog = little_endian_16(reply, 0);
      if (*decoded.analog >= kMcc1208Steps) return Refusal::kMalformed;
      return decoded;
    default:
      return reply.size() < kMcc1208Counter ? Refusal::kTooShort : Refusal::kMalformed;
  }
}

double mcc1208_volts(std::uint16_t analog, Mcc1208Range range) noexcept {
  if (range >= Mcc1208Range::kUnipolar5V) return analog * 5.0 / kMcc1208Steps;
  constexpr double kMiddle = kMcc1208Steps / 2.0;
  return (analog - kMiddle) * kMcc1208FullScale_v[static_cast<std::size_t>(range)] / kMiddle;
}

}  // namespace yuragi
