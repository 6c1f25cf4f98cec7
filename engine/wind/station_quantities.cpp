#include "engine/wind/station_quantities.hpp"

namespace yuragi::wind {

std::optional<StationQuantities> plausible_part(const StationQuantities& quantities) noexcept {
  StationQuantities part;
  part.time = quantities.time;
  bool is_empty = true;
  for (const StationQuantity& each : kStationQuantities) {
    const std::optional<double>& value = quantities.*each.value;
    if (!value || !(*value >= each.least && *value <= each.greatest)) continue;  // a NaN is in no interval
    part.*each.value = value;
    is_empty = false;
  }
  if (is_empty) return std::nullopt;
  return part;
}

}  // namespace yuragi::wind
