#include "drivers/decode/modbus/modbus_quantity.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/base/units.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::decode::modbus {
namespace {

std::uint16_t swapped(std::uint16_t value) {
  return static_cast<std::uint16_t>((value << 8U) | (value >> 8U));
}

/// The bits of the number, brought into the order ABCD.
std::uint32_t ordered_bits(const Quantity& quantity, std::span<const std::uint16_t> registers) {
  const bool swap_bytes = quantity.order == ByteOrder::kBADC || quantity.order == ByteOrder::kDCBA;
  const bool swap_words = quantity.order == ByteOrder::kCDAB || quantity.order == ByteOrder::kDCBA;
  const auto word = [&](std::size_t i) { return swap_bytes ? swapped(registers[i]) : registers[i]; };

  if (register_count(quantity.type) == 1) return word(0);
  const std::uint32_t high = word(swap_words ? 1 : 0);
  const std::uint32_t low = word(swap_words ? 0 : 1);
  return (high << 16U) | low;
}

/// The integer of the bits (for f32 the bits themselves), as in a profile's list of invalid values.
std::int64_t whole_number(RegisterType type, std::uint32_t bits) {
  switch (type) {
    case RegisterType::kI16:
      return static_cast<std::int16_t>(bits);
    case RegisterType::kI32:
      return static_cast<std::int32_t>(bits);
    case RegisterType::kU16:
    case RegisterType::kU32:
    case RegisterType::kF32:
      break;
  }
  return bits;
}

double metres_per_second(QuantityUnit unit) {
  switch (unit) {
    case QuantityUnit::kKmh:
      return kMetresPerSecondPerKmh;
    case QuantityUnit::kKnots:
      return kMetresPerSecondPerKnot;
    case QuantityUnit::kMph:
      return kMetresPerSecondPerMph;
    case QuantityUnit::kMetresPerSecond:
    case QuantityUnit::kDegrees:
      break;
  }
  return 1.0;
}

/// The compass point's direction; a number between two points, or beyond the last one, is none.
Result<double, Refusal> direction_of_point(double point, int points) {
  if (point < 0.0 || point >= points || point != std::floor(point)) return Refusal::kImplausible;
  return point * (360.0 / points);
}

}  // namespace

std::size_t register_count(RegisterType type) noexcept {
  return type == RegisterType::kU16 || type == RegisterType::kI16 ? 1 : 2;
}

Result<double, Refusal> decode_number(const Quantity& quantity, std::span<const std::uint16_t> registers) noexcept {
  if (registers.size() < register_count(quantity.type)) return Refusal::kTooShort;

  // The device's own mark for "no value"; a NaN is one by nature.
  const std::uint32_t bits = ordered_bits(quantity, registers);
  const std::int64_t whole = whole_number(quantity.type, bits);
  if (std::ranges::find(quantity.invalid, whole) != quantity.invalid.end()) return Refusal::kInvalid;
  const double raw = quantity.type == RegisterType::kF32 ? static_cast<double>(std::bit_cast<float>(bits))
                                                         : static_cast<double>(whole);
  if (std::isnan(raw)) return Refusal::kInvalid;

  const double value = raw * quantity.scale + quantity.offset;
  const bool in_range =
      std::isfinite(value) && (!quantity.min || value >= *quantity.min) && (!quantity.max || value <= *quantity.max);
  if (!in_range) return Refusal::kImplausible;
  return value;
}

Result<double, Refusal> decode_speed_m_s(const Quantity& quantity, std::span<const std::uint16_t> registers) noexcept {
  const auto number = decode_number(quantity, registers);
  if (!number) return number.error();
  const double speed_m_s = *number * metres_per_second(quantity.unit);
  if (!wind::is_plausible({.time = {}, .speed_m_s = speed_m_s, .direction_deg = {}, .gust_m_s = {}})) {
    return Refusal::kImplausible;
  }
  return speed_m_s;
}

Result<double, Refusal> decode_direction_deg(const Quantity& quantity,
                                             std::span<const std::uint16_t> registers) noexcept {
  const auto number = decode_number(quantity, registers);
  if (!number) return number.error();
  switch (quantity.map) {
    case DirectionMap::kGear8:
      return direction_of_point(*number, 8);
    case DirectionMap::kPoint16:
      return direction_of_point(*number, 16);
    case DirectionMap::kDegrees:
      break;
  }
  if (*number < 0.0 || *number > 360.0) return Refusal::kImplausible;
  return *number < 360.0 ? *number : 0.0;
}

}  // namespace yuragi::drivers::decode::modbus
