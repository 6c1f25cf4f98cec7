#pragma once

#include <algorithm>

#include <glm/vec2.hpp>

#include "engine/output/output.hpp"

namespace yuragi::viewer::wall {

/// The light of a strip at `into` of its width from the side.
inline double ramp(double into) {
  if (into >= 1.0) return 1.0;
  const double from_side = std::max(into, 0.0);
  return from_side < 0.5 ? 2.0 * from_side * from_side : 1.0 - 2.0 * (1.0 - from_side) * (1.0 - from_side);
}
inline double ramp(double distance, double width) {
  return width > 0.0 ? ramp(distance / width) : 1.0;
}

/// The part of the light at a place of the crop that the window shows, 0 to 1. In a strip of the width `blend` (parts
/// of the crop) it falls so that the neighbour's strip makes it 1 again. (P. Bourke, "Edge blending using commodity
/// projectors", 2004, with exponent 2.)
inline double blend_light(const glm::dvec2& place, const output::Sides& blend) {
  return ramp(place.x, blend.left) * ramp(1.0 - place.x, blend.right) * ramp(place.y, blend.top) *
         ramp(1.0 - place.y, blend.bottom);
}

}  // namespace yuragi::viewer::wall
