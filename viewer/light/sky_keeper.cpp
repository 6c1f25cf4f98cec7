#include "viewer/light/sky_keeper.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "viewer/light/palettes.hpp"

namespace yuragi::viewer::light {
namespace {

constexpr double kSecondsPerHour = 3600.0;
constexpr double kSecondsInDay = 86400.0;

// The evening that the first pictures had.
constexpr SkyPlace kEveningSun{8.5, 239.0};

// The exposure of the evening, and the share by which it follows the light: below 1, so that a night stays darker than
// a day.
constexpr double kEveningExposure = 0.545;
constexpr double kEveningBrightness = 1.65;
constexpr double kFollowing = 0.62;
constexpr double kFollowingInTheDark = 0.74;  // so that a night is visible
// In less light than a clear night of full moon the eye cannot adapt further, and the exposure follows little:
// starlight is darker, and an overcast night without a moon the darkest.
constexpr double kMoonlitBrightness = 0.055;
constexpr double kFollowingStarlight = 0.44;
constexpr double kAdapting_s = 12.0;

// Clouds move with a wind about twice as fast as that at the ground.
constexpr double kCloudHeight_m = 1500.0;
constexpr double kWindAloft = 2.0;
constexpr double kFastestClouds_m_s = 25.0;
constexpr double kWindSmoothing_s = 60.0;
constexpr double kDriftPeriod = 200.0;  // the noise's tiles repeat after this drift (sky.frag.glsl)

/// How far the sun is ahead of the clock at a place; assumes that all days are equally long.
double sun_ahead_s(double utc_s) {
  const double days = utc_s / kSecondsInDay - 10957.5;
  const double mean_longitude_deg = 280.46646 + 0.98564736 * days;
  const double ahead_deg = std::remainder(mean_longitude_deg - sun_among_stars(utc_s).right_ascension_deg, 360.0);
  return ahead_deg / 15.0 * kSecondsPerHour;
}

/// The moment of this day at which a sundial at this longitude shows this hour.
double at_solar_time_s(double hour, double utc_s, double longitude_deg) {
  const double ahead_s = longitude_deg / 15.0 * kSecondsPerHour + sun_ahead_s(utc_s);
  const double midnight_s = std::floor((utc_s + ahead_s) / kSecondsInDay) * kSecondsInDay;
  return midnight_s + hour * kSecondsPerHour - ahead_s;
}

double exposure_log_for(const Light& light) {
  const double brightness = std::max(1e-4, static_cast<double>(brightness_of(light)));
  const double log_ratio = std::log(brightness / kEveningBrightness);
  const double log_below_moonlight = std::min(0.0, std::log(brightness / kMoonlitBrightness));
  return std::log(kEveningExposure) -
         (log_ratio < 0.0 ? kFollowingInTheDark : kFollowing) * (log_ratio - log_below_moonlight) -
         kFollowingStarlight * log_below_moonlight;
}

double share_of(double passed_s, double time_s) {
  return 1.0 - std::exp(-std::max(0.0, passed_s) / time_s);
}

}  // namespace

Sky sky_of(const look::Look& look, double utc_s) {
  Sky sky{.sun = kEveningSun, .moon = {}, .moon_lit_share = 0.0, .clouds = look.clouds, .haze = look.haze};
  switch (look.sun) {
    case look::SunChoice::kEvening:
      break;
    case look::SunChoice::kFixed:
      // The moon is opposite, for a sun that has set.
      sky.sun = {look.sun_height_deg, look.sun_azimuth_deg};
      sky.moon = {32.0, look.sun_azimuth_deg + 180.0};
      sky.moon_lit_share = look.sun_height_deg < 0.0 ? 0.95 : 0.0;
      break;
    case look::SunChoice::kTime: {
      const double at_s = look.solar_time_h ? at_solar_time_s(*look.solar_time_h, utc_s, look.longitude_deg) : utc_s;
      sky.sun = sun_place(at_s, look.latitude_deg, look.longitude_deg);
      sky.moon = moon_place(at_s, look.latitude_deg, look.longitude_deg);
      sky.moon_lit_share = moon_lit_share(at_s);
      break;
    }
  }
  return sky;
}

Light light_of(const look::Look& look, double utc_s) {
  SkyKeeper keeper;
  keeper.start(look);
  return keeper.advance(utc_s, 0.0, {});
}

void SkyKeeper::start(const look::Look& look) {
  look_ = look;
  has_light_ = false;
  fade_s_ = over_s_;
}

void SkyKeeper::set_look(const look::Look& look, double over_s) {
  if (look == look_) return;
  look_ = look;
  before_ = shown_;
  fade_s_ = 0.0;
  over_s_ = over_s;
}

const Light& SkyKeeper::advance(double utc_s, double dt_s, const glm::dvec2& wind_m_s) {
  dt_s = std::clamp(dt_s, 0.0, 10.0);
  slow_wind_m_s_ += (has_light_ ? share_of(dt_s, kWindSmoothing_s) : 1.0) * (wind_m_s - slow_wind_m_s_);
  const double speed_m_s = kWindAloft * glm::length(slow_wind_m_s_);
  const double most = speed_m_s > kFastestClouds_m_s ? kFastestClouds_m_s / speed_m_s : 1.0;
  drift_ += slow_wind_m_s_ * (kWindAloft * most * dt_s / kCloudHeight_m);
  drift_ = glm::mod(drift_, kDriftPeriod);

  Light now = daylight(sky_of(look_, utc_s));
  now.drift = {drift_.x, drift_.y, now.drift.z, now.drift.w};
  set_colors(look_, now);
  const double wanted_log = exposure_log_for(now);
  // During a fade of the look the exposure follows it at once: the slow adaptation does not delay a requested change.
  const bool follows_at_once = !has_light_ || fade_s_ < over_s_;
  exposure_log_ += (follows_at_once ? 1.0 : share_of(dt_s, kAdapting_s)) * (wanted_log - exposure_log_);
  now.air.x =
      static_cast<float>(std::exp(exposure_log_) * std::exp2(look_.exposure_ev + static_cast<double>(now.colors.w)));

  fade_s_ = std::min(over_s_, fade_s_ + dt_s);
  const auto share = static_cast<float>(fade_s_ / over_s_);
  shown_ = has_light_ && share < 1.0F ? mixed(before_, now, share * share * (3.0F - 2.0F * share)) : now;
  has_light_ = true;
  return shown_;
}

}  // namespace yuragi::viewer::light
