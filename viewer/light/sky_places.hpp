#pragma once

#include <glm/vec3.hpp>

namespace yuragi::viewer::light {

/// Apparent place of an object in the sky.
struct SkyPlace {
  double height_deg = 0.0;   ///< above the horizon
  double azimuth_deg = 0.0;  ///< 0 north, 90 east
};

/// The unit vector toward it, in the world.
glm::dvec3 direction_of(const SkyPlace& place);

/// Place among the stars: equatorial coordinates of the date.
struct StarPlace {
  double right_ascension_deg = 0.0;
  double declination_deg = 0.0;
};

// A place on the earth: latitude, north above 0, and longitude, east above 0, in degrees. Times: seconds since 1970,
// UTC.

/// The sun, to about 0.01 degree from 1900 to 2100 (J. Meeus 1998, "Astronomical Algorithms", 2nd edition, chapter 25,
/// low accuracy).
StarPlace sun_among_stars(double utc_s);
/// The apparent place, raised by refraction (chapters 12, 13 and 16).
SkyPlace sun_place(double utc_s, double latitude_deg, double longitude_deg);

/// The moon, to about 0.3 degree ("The Astronomical Almanac", section D, low-precision formulae for geocentric
/// coordinates).
StarPlace moon_among_stars(double utc_s);
/// The apparent place, lowered by parallax.
SkyPlace moon_place(double utc_s, double latitude_deg, double longitude_deg);

/// The share of the moon's disc that is lit, 0 (new) to 1 (full).
double moon_lit_share(double utc_s);

}  // namespace yuragi::viewer::light
