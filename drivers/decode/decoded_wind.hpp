#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode {

/// The frame of a direction, clockwise, as far as the message itself states it.
enum class WindReference : std::uint8_t {
  kUnknown,   ///< not stated: for a fixed device its own north mark
  kRelative,  ///< the device's mark or the vessel's bow; on a moving vessel the apparent wind
  kTrue,      ///< still the bow, but the vessel's own motion is taken out ("true wind" of MWV and VWT)
  kNorth,     ///< geographic north
  kMagnetic,  ///< magnetic north: the local variation (east positive) is still to be added
};
inline constexpr std::array<std::string_view, 5> kWindReferenceNames = {"unknown", "relative", "true", "north",
                                                                        "magnetic"};

/// The status of the values as the device reports it. Values that it reports as invalid are a Refusal, not a status.
enum class DecodedStatus : std::uint8_t {
  kGood,       ///< the device reports no fault, or its protocol has no status
  kUncertain,  ///< the device flags something (low battery, partial data), or leaves out the status that is due
};
inline constexpr std::array<std::string_view, 2> kDecodedStatusNames = {"good", "uncertain"};

/// The values of one message of any anemometer: SI units, no time, before calibration. The result of every decoder but
/// Modbus's. At least one value is there; a value that is not known is empty, never 0.
struct DecodedWind {
  std::optional<double> speed_m_s;      ///< [0, kMaxPlausibleSpeed_m_s]
  std::optional<double> direction_deg;  ///< where the wind comes *from*, clockwise from `reference`, [0, 360)
  std::optional<double> gust_m_s;       ///< the strongest of the device's own recent past, never below the speed
  WindReference reference = WindReference::kUnknown;
  DecodedStatus status = DecodedStatus::kGood;

  bool operator==(const DecodedWind&) const = default;
};

std::string_view name_of(WindReference reference) noexcept;
std::string_view name_of(DecodedStatus status) noexcept;

/// A direction in [0, 360): 360 is 0, and a whole turn too many (530) is taken off. Empty for what is negative, from
/// 720 on, or not finite. Thread-safe and realtime-safe: yes.
std::optional<double> wrapped_direction_deg(double direction_deg) noexcept;

/// The last step of every decoder: `wind` itself if at least one value is there and all are as DecodedWind promises;
/// kInvalid if none is there, kImplausible if one is out of its range. A gust below the speed is none, and left
/// out. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> checked(const DecodedWind& wind) noexcept;

}  // namespace yuragi::drivers::decode
