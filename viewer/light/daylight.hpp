#pragma once

#include <glm/vec3.hpp>

#include "viewer/light/light.hpp"
#include "viewer/light/sky_places.hpp"

namespace yuragi::viewer::light {

/// The conditions that determine the light.
struct Sky {
  SkyPlace sun = {};
  SkyPlace moon = {};
  double moon_lit_share = 0.0;  ///< of its disc; 0: no moon
  double clouds = 0.0;          ///< 0: clear, 1: overcast
  double haze = 0.0;            ///< 0: very clear air, 1: fog
};

/// The sun's light after its way through clear air: by the optical depth of the air (B. Leckner 1978, "The spectral
/// distribution of solar radiation at the earth's surface") and the air mass (F. Kasten, A. T. Young 1989, "Revised
/// optical air mass tables"). 0 if it has set.
glm::vec3 sunlight_at(double height_deg);

/// The light of a sky, except exposure and drift, which SkyKeeper knows, and the colors of things (palettes.hpp).
Light daylight(const Sky& sky);

}  // namespace yuragi::viewer::light
