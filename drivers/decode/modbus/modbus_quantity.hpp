#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::modbus {

/// How a device writes one number into its registers. The texts of these enums, in their order, are those of profiles.
enum class RegisterType : std::uint8_t { kU16, kI16, kU32, kI32, kF32 };
inline constexpr std::array<std::string_view, 5> kRegisterTypeNames = {"u16", "i16", "u32", "i32", "f32"};

/// The order in which the bytes of a number come, A being the most significant. 16-bit numbers know AB (in ABCD and
/// CDAB) and BA (in BADC and DCBA).
enum class ByteOrder : std::uint8_t { kABCD, kCDAB, kBADC, kDCBA };
inline constexpr std::array<std::string_view, 4> kByteOrderNames = {"ABCD", "CDAB", "BADC", "DCBA"};

enum class QuantityUnit : std::uint8_t { kMetresPerSecond, kKmh, kKnots, kMph, kDegrees };
inline constexpr std::array<std::string_view, 5> kQuantityUnitNames = {"m/s", "km/h", "kn", "mph", "deg"};

/// What the number means, once scaled: itself, or a point of the compass counted clockwise from north (N = 0).
enum class DirectionMap : std::uint8_t { kDegrees, kGear8, kPoint16 };
inline constexpr std::array<std::string_view, 3> kDirectionMapNames = {"degrees", "8-gear", "16-point"};

/// One quantity of a device: its registers and how they are decoded.
struct Quantity {
  std::uint8_t slave = 1;
  std::uint8_t function = 3;
  std::uint16_t address = 0;  ///< as sent
  RegisterType type = RegisterType::kU16;
  ByteOrder order = ByteOrder::kABCD;
  double scale = 1.0;  ///< value = raw * scale + offset, in `unit`
  double offset = 0.0;
  QuantityUnit unit = QuantityUnit::kMetresPerSecond;
  DirectionMap map = DirectionMap::kDegrees;
  std::vector<std::int64_t> invalid;  ///< raw numbers that mean "no value"; for f32 the bits as an unsigned number
  std::optional<double> min;          ///< the value's range as the maker states it, in `unit`, inclusive
  std::optional<double> max;
  bool read_has_side_effect = false;  ///< reading resets something: never read it together with others
};

/// Registers that a number of this type takes: 1 or 2.
std::size_t register_count(RegisterType type) noexcept;

/// The number that `registers` (register_count() of them, in wire order) hold, scaled, in any unit; or why there is
/// none: kTooShort, kInvalid (the device's mark), kImplausible (out of the stated range, or not finite). Thread-safe,
/// realtime-safe: yes.
Result<double, Refusal> decode_number(const Quantity& quantity, std::span<const std::uint16_t> registers) noexcept;

/// The same for a speed, in m/s; kImplausible also for one that no wind has.
Result<double, Refusal> decode_speed_m_s(const Quantity& quantity, std::span<const std::uint16_t> registers) noexcept;

/// The same for a direction: degrees clockwise from north that the wind comes from, [0, 360); 360 is 0.
Result<double, Refusal> decode_direction_deg(const Quantity& quantity,
                                             std::span<const std::uint16_t> registers) noexcept;

}  // namespace yuragi::drivers::decode::modbus
