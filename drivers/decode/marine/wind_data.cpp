#include "drivers/decode/marine/wind_data.hpp"

#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

constexpr std::size_t kMinData = 6;
constexpr std::size_t kMaxData = 8;
constexpr std::uint16_t kFirstWithoutValue = 0xFFFD;
constexpr double kSpeedUnit_m_s = 0.01;
constexpr double kAngleUnit_rad = 0.0001;
constexpr double kWholeTurn_rad = 6.2832;  // as the bus rounds it
constexpr unsigned kReferenceBits = 0x07;
constexpr unsigned kUnknownReference = 7;

std::optional<double> bus_value(ByteSpan data, std::size_t at, double unit) {
  const std::uint16_t raw = little_endian_16(data, at);
  return raw < kFirstWithoutValue ? std::optional(raw * unit) : std::nullopt;
}

}  // namespace

WindReference wind_reference_of(WindDataReference reference) noexcept {
  switch (reference) {
    case WindDataReference::kNorth:
      return WindReference::kNorth;
    case WindDataReference::kMagnetic:
      return WindReference::kMagnetic;
    case WindDataReference::kApparent:
      return WindReference::kRelative;
    case WindDataReference::kBoat:
    case WindDataReference::kWater:
      return WindReference::kTrue;
    case WindDataReference::kUnknown:
      break;
  }
  return WindReference::kUnknown;
}

std::optional<double> direction_of_angle_deg(double angle_rad) noexcept {
  constexpr double kHalfUnit_rad = kAngleUnit_rad / 2.0;
  if (!(angle_rad >= 0.0 && angle_rad <= kWholeTurn_rad + kHalfUnit_rad)) return {};
  return wrapped_direction_deg(angle_rad / kRadPerDeg);
}

Result<BusWind, Refusal> decode_wind_data(std::uint8_t address, ByteSpan data) noexcept {
  if (data.size() < kMinData) return Refusal::kTooShort;
  if (data.size() > kMaxData) return Refusal::kMalformed;
  const unsigned reference = data[5] & kReferenceBits;
  if (reference > static_cast<unsigned>(WindDataReference::kWater) && reference != kUnknownReference)
    return Refusal::kMalformed;

  BusWind said;
  said.address = address;
  said.reference =
      reference == kUnknownReference ? WindDataReference::kUnknown : static_cast<WindDataReference>(reference);
  said.wind.reference = wind_reference_of(said.reference);
  said.wind.speed_m_s = bus_value(data, 1, kSpeedUnit_m_s);
  if (!said.wind.speed_m_s) return Refusal::kInvalid;
  if (const auto angle_rad = bus_value(data, 3, kAngleUnit_rad)) {
    said.wind.direction_deg = direction_of_angle_deg(*angle_rad);
    if (!said.wind.direction_deg) said.wind.status = DecodedStatus::kUncertain;
  }
  const auto wind = checked(said.wind);
  if (!wind) return wind.error();
  return said;
}

}  // namespace yuragi::drivers::decode::marine
