#include "viewer/light/sky_places.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace yuragi::viewer::light {
namespace {

// J. Meeus 1998, "Astronomical Algorithms": 0 h TD, which was 59 s ahead of UTC in 1992.
constexpr double kClockAhead1992_s = 58.7 - 69.2;
constexpr double kOctober1992_s = 718934400.0 - kClockAhead1992_s - 69.2;
constexpr double kApril1992_s = 703036800.0 - kClockAhead1992_s - 69.2;

TEST(SkyPlaces, HaveTheSunWhereMeeusHasIt) {
  // Example 25.a, 1992 October 13.
  const StarPlace sun = sun_among_stars(kOctober1992_s);
  EXPECT_NEAR(sun.right_ascension_deg, 198.38083, 0.01);
  EXPECT_NEAR(sun.declination_deg, -7.78507, 0.01);
}

TEST(SkyPlaces, HaveTheMoonWhereMeeusHasIt) {
  // Example 47.a, 1992 April 12.
  const StarPlace moon = moon_among_stars(kApril1992_s);
  EXPECT_NEAR(moon.right_ascension_deg, 134.688470, 0.4);
  EXPECT_NEAR(moon.declination_deg, 13.768368, 0.4);
  EXPECT_NEAR(moon_lit_share(kApril1992_s), 0.6786, 0.01) << "example 48.a";
}

TEST(SkyPlaces, HaveTheSunInTheSkyWhereNrelHasIt) {
  // I. Reda, A. Andreas 2004, "Solar position algorithm for solar radiation applications", table A5.1: Golden,
  // Colorado, 2003-10-17 12:30:30 at UTC - 7 h.
  const SkyPlace sun = sun_place(1066419030.0, 39.742476, -105.1786);
  EXPECT_NEAR(sun.height_deg, 90.0 - 50.11162, 0.02);
  EXPECT_NEAR(sun.azimuth_deg, 194.34024, 0.02);
}

TEST(SkyPlaces, AreSeenInTheirDirection) {
  const glm::dvec3 east = direction_of({0.0, 90.0});
  EXPECT_NEAR(east.x, 1.0, 1e-9);
  EXPECT_NEAR(direction_of({0.0, 180.0}).z, 1.0, 1e-9) << "south";
  EXPECT_NEAR(direction_of({90.0, 0.0}).y, 1.0, 1e-9);
}

TEST(SkyPlaces, MoveWithoutAJump) {
  for (int minute = 0; minute < 2 * 1440; ++minute) {
    const double utc_s = 1.79e9 + 60.0 * minute;
    for (const auto& place : {sun_place, moon_place}) {
      const SkyPlace before = place(utc_s, 35.68, 139.77);
      const SkyPlace after = place(utc_s + 60.0, 35.68, 139.77);
      ASSERT_LT(std::abs(after.height_deg - before.height_deg), 0.4) << utc_s;
      ASSERT_TRUE(std::isfinite(after.azimuth_deg));
    }
  }
}

}  // namespace
}  // namespace yuragi::viewer::light
