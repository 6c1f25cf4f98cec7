#include "viewer/light/sky_places.hpp"

#include <algorithm>
#include <cmath>

#include <glm/trigonometric.hpp>

namespace yuragi::viewer::light {
namespace {

constexpr double kSecondsPerDay = 86400.0;
constexpr double kDays1970To2000 = 10957.5;  // to 2000-01-01, 12 h
constexpr double kDaysPerCentury = 36525.0;
// Between the clock and the motion of the planets, TT - UTC: 69.2 s since 2017.
constexpr double kClockLag_s = 69.2;

double sine_deg(double angle_deg) {
  return std::sin(glm::radians(angle_deg));
}
double cosine_deg(double angle_deg) {
  return std::cos(glm::radians(angle_deg));
}
double whole_turn_deg(double angle_deg) {
  const double rest = std::fmod(angle_deg, 360.0);
  return rest < 0.0 ? rest + 360.0 : rest;
}

double days_since_2000(double utc_s) {
  return utc_s / kSecondsPerDay - kDays1970To2000;
}
double centuries_since_2000(double utc_s) {
  return (days_since_2000(utc_s) + kClockLag_s / kSecondsPerDay) / kDaysPerCentury;
}

double obliquity_deg(double centuries) {
  return 23.439291 - 0.0130042 * centuries;
}

/// Converts ecliptic coordinates (chapter 13).
StarPlace on_equator(double longitude_deg, double latitude_deg, double tilt_deg) {
  const double y =
      sine_deg(longitude_deg) * cosine_deg(tilt_deg) - std::tan(glm::radians(latitude_deg)) * sine_deg(tilt_deg);
  const double sine = sine_deg(latitude_deg) * cosine_deg(tilt_deg) +
                      cosine_deg(latitude_deg) * sine_deg(tilt_deg) * sine_deg(longitude_deg);
  return {whole_turn_deg(glm::degrees(std::atan2(y, cosine_deg(longitude_deg)))),
          glm::degrees(std::asin(std::clamp(sine, -1.0, 1.0)))};
}

/// The place as seen from the middle of the earth (chapters 12 and 13).
SkyPlace above_horizon(const StarPlace& star, double utc_s, double latitude_deg, double longitude_deg) {
  const double sidereal_deg = 280.46061837 + 360.98564736629 * days_since_2000(utc_s) + longitude_deg;
  const double hour_deg = sidereal_deg - star.right_ascension_deg;
  const double south = cosine_deg(hour_deg) * sine_deg(latitude_deg) -
                       std::tan(glm::radians(star.declination_deg)) * cosine_deg(latitude_deg);
  const double sine = sine_deg(latitude_deg) * sine_deg(star.declination_deg) +
                      cosine_deg(latitude_deg) * cosine_deg(star.declination_deg) * cosine_deg(hour_deg);
  return {glm::degrees(std::asin(std::clamp(sine, -1.0, 1.0))),
          whole_turn_deg(180.0 + glm::degrees(std::atan2(sine_deg(hour_deg), south)))};
}

/// The apparent rise near the horizon by refraction (chapter 16, by G. Saemundsson 1986).
double refraction_deg(double height_deg) {
  const double height = std::max(height_deg, -1.0);
  const double raised_deg = 1.02 / 60.0 / std::tan(glm::radians(height + 10.3 / (height + 5.11)));
  return raised_deg * std::clamp(height_deg + 3.0, 0.0, 2.0) / 2.0;  // fades out below the horizon
}

double sun_longitude_deg(double t) {
  const double anomaly_deg = 357.52911 + t * (35999.05029 - 0.0001537 * t);
  const double center_deg = (1.914602 - t * (0.004817 + 0.000014 * t)) * sine_deg(anomaly_deg) +
                            (0.019993 - 0.000101 * t) * sine_deg(2.0 * anomaly_deg) +
                            0.000289 * sine_deg(3.0 * anomaly_deg);
  return 280.46646 + t * (36000.76983 + 0.0003032 * t) + center_deg;
}

double moon_longitude_deg(double t) {
  return 218.32 + 481267.881 * t + 6.29 * sine_deg(135.0 + 477198.87 * t) - 1.27 * sine_deg(259.3 - 413335.36 * t) +
         0.66 * sine_deg(235.7 + 890534.22 * t) + 0.21 * sine_deg(269.9 + 954397.74 * t) -
         0.19 * sine_deg(357.5 + 35999.05 * t) - 0.11 * sine_deg(186.5 + 966404.03 * t);
}
double moon_latitude_deg(double t) {
  return 5.13 * sine_deg(93.3 + 483202.02 * t) + 0.28 * sine_deg(228.2 + 960400.89 * t) -
         0.28 * sine_deg(318.3 + 6003.15 * t) - 0.17 * sine_deg(217.6 - 407332.21 * t);
}
double moon_parallax_deg(double t) {
  return 0.9508 + 0.0518 * cosine_deg(135.0 + 477198.87 * t) + 0.0095 * cosine_deg(259.3 - 413335.36 * t) +
         0.0078 * cosine_deg(235.7 + 890534.22 * t) + 0.0028 * cosine_deg(269.9 + 954397.74 * t);
}

}  // namespace

glm::dvec3 direction_of(const SkyPlace& place) {
  const double level = cosine_deg(place.height_deg);
  return {sine_deg(place.azimuth_deg) * level, sine_deg(place.height_deg), -cosine_deg(place.azimuth_deg) * level};
}

StarPlace sun_among_stars(double utc_s) {
  const double t = centuries_since_2000(utc_s);
  const double node_deg = 125.04 - 1934.136 * t;
  const double apparent_deg = sun_longitude_deg(t) - 0.00569 - 0.00478 * sine_deg(node_deg);
  return on_equator(apparent_deg, 0.0, obliquity_deg(t) + 0.00256 * cosine_deg(node_deg));
}

SkyPlace sun_place(double utc_s, double latitude_deg, double longitude_deg) {
  SkyPlace place = above_horizon(sun_among_stars(utc_s), utc_s, latitude_deg, longitude_deg);
  place.height_deg += refraction_deg(place.height_deg);
  return place;
}

StarPlace moon_among_stars(double utc_s) {
  const double t = centuries_since_2000(utc_s);
  return on_equator(moon_longitude_deg(t), moon_latitude_deg(t), obliquity_deg(t));
}

SkyPlace moon_place(double utc_s, double latitude_deg, double longitude_deg) {
  SkyPlace place = above_horizon(moon_among_stars(utc_s), utc_s, latitude_deg, longitude_deg);
  place.height_deg -= moon_parallax_deg(centuries_since_2000(utc_s)) * cosine_deg(place.height_deg);
  place.height_deg += refraction_deg(place.height_deg);
  return place;
}

double moon_lit_share(double utc_s) {
  // The angle between the two (chapter 48); the sun is so far away that the moon's latitude hardly matters.
  const double t = centuries_since_2000(utc_s);
  const double cosine = cosine_deg(moon_latitude_deg(t)) * cosine_deg(moon_longitude_deg(t) - sun_longitude_deg(t));
  return 0.5 * (1.0 - cosine);
}

}  // namespace yuragi::viewer::light
