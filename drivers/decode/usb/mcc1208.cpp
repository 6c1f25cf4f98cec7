#include "drivers/decode/usb/mcc1208.hpp"

#include <bit>
#include <cmath>
#include <optional>

namespace yuragi::drivers::decode::usb {
namespace {

constexpr std::uint16_t kMcc1208Steps = 4096;
constexpr double kMcc1208FullScale_v = 10.0;

/// The error in the length of a reply to this request.
std::optional<Refusal> wrong_length(ByteSpan reply, const Mcc1208Transfer& request) {
  if (reply.size() < request.length) return Refusal::kTooShort;
  if (reply.size() > request.length) return Refusal::kMalformed;
  return std::nullopt;
}

}  // namespace

Result<std::uint32_t, Refusal> decode_mcc1208_count(ByteSpan reply) noexcept {
  if (const auto why = wrong_length(reply, kMcc1208ReadCounter)) return *why;
  return little_endian_32(reply, 0);
}

Result<std::uint16_t, Refusal> decode_mcc1208_analog(ByteSpan reply) noexcept {
  if (const auto why = wrong_length(reply, mcc1208_read_analog(0))) return *why;
  const std::uint16_t analog = little_endian_16(reply, 0);
  if (analog >= kMcc1208Steps) return Refusal::kMalformed;
  return analog;
}

Result<Mcc1208Calibration, Refusal> decode_mcc1208_calibration(ByteSpan reply) noexcept {
  if (const auto why = wrong_length(reply, mcc1208_read_calibration(0))) return *why;
  const Mcc1208Calibration calibration = {
      .slope = static_cast<double>(std::bit_cast<float>(little_endian_32(reply, 0))),
      .intercept_steps = static_cast<double>(std::bit_cast<float>(little_endian_32(reply, 4)))};
  constexpr double kMaxSlope = 0.2;
  constexpr double kMaxIntercept_steps = 256.0;
  const bool is_believable =
      std::abs(calibration.slope - 1.0) <= kMaxSlope && std::abs(calibration.intercept_steps) <= kMaxIntercept_steps;
  if (!is_believable) return Refusal::kInvalid;
  return calibration;
}

double mcc1208_volts(std::uint16_t analog, const Mcc1208Calibration& calibration) noexcept {
  constexpr double kMiddle = kMcc1208Steps / 2.0;
  return (analog * calibration.slope + calibration.intercept_steps - kMiddle) * kMcc1208FullScale_v / kMiddle;
}

}  // namespace yuragi::drivers::decode::usb
