#include "drivers/decode/decoded_wind.hpp"

#include <cmath>
#include <cstddef>

#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::decode {
namespace {

constexpr double kTurn_deg = 360.0;

/// Returns true if the value is absent, or in the closed interval. A NaN never is.
bool is_within(const std::optional<double>& value, double low, double high) {
  return !value || (*value >= low && *value <= high);
}

}  // namespace

std::string_view name_of(WindReference reference) noexcept {
  return kWindReferenceNames[static_cast<std::size_t>(reference)];
}

std::string_view name_of(DecodedStatus status) noexcept {
  return kDecodedStatusNames[static_cast<std::size_t>(status)];
}

std::optional<double> wrapped_direction_deg(double direction_deg) noexcept {
  if (!(direction_deg >= 0.0) || direction_deg >= 2.0 * kTurn_deg) return {};
  return direction_deg < kTurn_deg ? std::abs(direction_deg) : direction_deg - kTurn_deg;
}

Result<DecodedWind, Refusal> checked(const DecodedWind& wind) noexcept {
  if (!wind.speed_m_s && !wind.direction_deg && !wind.gust_m_s) return Refusal::kInvalid;
  const bool is_physical = is_within(wind.speed_m_s, 0.0, wind::kMaxPlausibleSpeed_m_s) &&
                           is_within(wind.gust_m_s, 0.0, wind::kMaxPlausibleSpeed_m_s) &&
                           is_within(wind.direction_deg, 0.0, kTurn_deg) && wind.direction_deg != kTurn_deg;
  if (!is_physical) return Refusal::kImplausible;
  DecodedWind sound = wind;
  if (wind.gust_m_s < wind.speed_m_s) sound.gust_m_s.reset();
  return sound;
}

}  // namespace yuragi::drivers::decode
