#include "engine/base/compass.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace yuragi {
namespace {

char capital(char c) noexcept {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

}  // namespace

std::string_view nearest_compass_point(double direction_deg) noexcept {
  const double turns = direction_deg / 360.0 - std::floor(direction_deg / 360.0);
  return kCompassPoints[static_cast<std::size_t>(std::lround(turns * 16.0)) % kCompassPoints.size()];
}

std::optional<double> compass_point_deg(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kCompassPoints.size(); ++i) {
    const bool is_it = std::equal(name.begin(), name.end(), kCompassPoints[i].begin(), kCompassPoints[i].end(),
                                  [](char given, char point) { return capital(given) == point; });
    if (is_it) return kDegPerCompassPoint * static_cast<double>(i);
  }
  return std::nullopt;
}

}  // namespace yuragi
