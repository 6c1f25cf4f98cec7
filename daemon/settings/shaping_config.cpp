#include "daemon/settings/shaping_config.hpp"

#include "daemon/settings/wind_settings.hpp"

namespace yuragi {
namespace {

constexpr double kSecondsPerDay = 86400.0;

}  // namespace

WindShapingSettings shaping_settings(const Config& config) {
  const ParameterValues& shaping = config.shaping;
  WindShapingSettings settings{.floor_m_s = shaping.number("floor"),
                               .site = {.median_m_s = shaping.number("site_median"),
                                        .strong_m_s = shaping.number("site_strong"),
                                        .most_gain = shaping.number("site_most_gain")},
                               .site_memory_s = kSecondsPerDay * shaping.number("site_memory"),
                               .over_s = shaping.number("over"),
                               .gusts = shaping.number("gusts"),
                               .ceiling = {},
                               .closed_level = shaping.number("closed"),
                               .fade_s = shaping.number("fade"),
                               .turbulence_intensity = config.wind.number("default_turbulence"),
                               .length_m = default_gust_length_m(config)};
  if (const double ceiling_m_s = shaping.number("ceiling"); ceiling_m_s > 0.0) {
    settings.ceiling = {.from_m_s = ceiling_m_s, .most_m_s = shaping.number("ceiling_most")};
  }
  return settings;
}

OpeningHours opening_hours(const Config& config) {
  return OpeningHours::parse(config.shaping.text("hours"), config.shaping.text("zone")).value();
}

}  // namespace yuragi
