#include "drivers/decode/usb/potentiometer_vane.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::drivers::decode::usb {

std::optional<double> vane_direction_deg(const VaneCalibration& vane, double wiper_v, double reference_v) noexcept {
  if (!std::isfinite(wiper_v) || !std::isfinite(reference_v) || reference_v <= 0.0) return std::nullopt;
  const double ratio = wiper_v / reference_v;
  const bool is_on_track =
      ratio >= vane.lowest_ratio - vane.tolerance_ratio && ratio <= vane.highest_ratio + vane.tolerance_ratio;
  if (!is_on_track) return std::nullopt;

  const double share = std::clamp((ratio - vane.lowest_ratio) / (vane.highest_ratio - vane.lowest_ratio), 0.0, 1.0);
  double direction_deg = std::fmod(vane.start_deg + share * vane.electrical_deg, 360.0);
  if (direction_deg < 0.0) direction_deg += 360.0;
  if (direction_deg >= 360.0) direction_deg = 0.0;  // a negative hair rounds up to a whole turn
  if (std::isnan(direction_deg)) return std::nullopt;
  return direction_deg;
}

}  // namespace yuragi::drivers::decode::usb
