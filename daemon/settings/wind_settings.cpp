#include "daemon/settings/wind_settings.hpp"

#include <algorithm>

#include "daemon/settings/site_octaves.hpp"
#include "engine/wind/blend/blend_settings.hpp"
#include "engine/wind/turbulence/wind_profile.hpp"

namespace yuragi {
namespace {

constexpr double kShortestGusts_m = 1.0;

}  // namespace

double default_gust_length_m(const Config& config) {
  const double length_m = config.wind.number("default_length");
  return length_m > 0.0 ? std::max(length_m, kShortestGusts_m) : BlendSettings{}.length_m;
}

bool is_length_by_height(const Config& config, const SensorConfig& sensor) {
  return config.wind.number("default_length") <= 0.0 && sensor.calibration.number("height") > 0.0;
}

double gust_length_m(const Config& config, const SensorConfig& sensor) {
  if (!is_length_by_height(config, sensor)) return default_gust_length_m(config);
  const double length_m = iec_length_scale_m(WindComponent::kAlong, sensor.calibration.number("height"));
  return std::max(calibration_of(sensor).height_factor * length_m, kShortestGusts_m);
}

std::shared_ptr<SiteSpectrum> make_site_spectrum(const Config& config) {
  auto site = std::make_shared<SiteSpectrum>();
  site->expect(parse_site_octaves(config.wind.text("site_octaves")).value());
  return site;
}

bool has_fallback(const Config& config) {
  return !config.wind.text("fallback_recording").empty();
}

}  // namespace yuragi
