#include "daemon/settings/shaping_config.hpp"

#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace yuragi::daemon::settings {
namespace {

constexpr double kSecondsPerDay = 86400.0;

const std::array kShapingParameters = {
    Parameter{.name = "floor",
              .unit = "m/s",
              .default_value = 0.0,
              .min = 0.0,
              .max = 10.0,
              .help = "least mean speed: a weaker wind is slowly raised to it, with its gusts; 0: none"},
    Parameter{.name = "site_median",
              .unit = "m/s",
              .default_value = 0.0,
              .min = 0.0,
              .max = 30.0,
              .help = "speed to which a slow gain scales the site's median wind; 0: no site gain"},
    Parameter{
        .name = "site_strong",
        .unit = "m/s",
        .default_value = 0.0,
        .min = 0.0,
        .max = 40.0,
        .help = "speed to which the site's strong wind (95th percentile) is scaled; 0: the gain of the median applies"},
    Parameter{.name = "site_most_gain",
              .unit = "",
              .default_value = 3.0,
              .min = 1.0,
              .max = 10.0,
              .help = "the largest site gain; the smallest is 1 over this"},
    Parameter{
        .name = "site_memory",
        .unit = "days",
        .default_value = 7.0,
        .min = 0.1,
        .max = 365.0,
        .help = "memory of the site's wind for these; the gain starts at 1 and takes effect over the first 6 hours"},
    Parameter{.name = "site_file",
              .unit = "",
              .default_value = std::string(""),
              .help = "file that keeps this memory and the fit of the site's gusts (site_octaves of [wind]) over a "
                      "restart; empty: both start anew"},
    Parameter{.name = "over",
              .unit = "s",
              .default_value = 120.0,
              .min = 10.0,
              .max = 3600.0,
              .help = "time in which floor and site gain follow the mean wind"},
    Parameter{.name = "gusts",
              .unit = "",
              .default_value = 1.0,
              .min = 0.0,
              .max = 3.0,
              .help = "strength of gusts and lulls relative to the real ones: 0: steady wind, 1: unchanged, 2: twice "
                      "as strong; the mean speed is unchanged"},
    Parameter{.name = "ceiling",
              .unit = "m/s",
              .default_value = 17.0,
              .min = 0.0,
              .max = 75.0,
              .help = "speed above which the wind is compressed; 0: never"},
    Parameter{.name = "ceiling_most",
              .unit = "m/s",
              .default_value = 25.0,
              .min = 1.0,
              .max = 100.0,
              .help = "limit that the compressed speed approaches; must be above ceiling"},
    Parameter{.name = "hours",
              .unit = "",
              .default_value = std::string(""),
              .help = "opening hours in local time, \"10:00-18:00\" or \"Tue-Sun 10:00-18:00, Thu 18:00-21:00\"; "
                      "outside of them the wind fades out; empty: always open"},
    Parameter{
        .name = "zone",
        .unit = "",
        .default_value = std::string(""),
        .help = "time zone of the hours, and of the cameras' times: \"Europe/Berlin\"; empty: that of this machine"},
    Parameter{.name = "closed",
              .unit = "",
              .default_value = 0.0,
              .min = 0.0,
              .max = 1.0,
              .help = "part of the wind that remains when closed; 0: calm"},
    Parameter{.name = "fade",
              .unit = "s",
              .default_value = 300.0,
              .min = 1.0,
              .max = 7200.0,
              .help = "duration of the fade between open and closed, from the opening or closing time on"},
};

/// The contradictions among the speeds of site gain and ceiling.
std::vector<ParameterError> speed_mistakes(const wind::shaping::SiteRange& site, double ceiling_m_s,
                                           double ceiling_most_m_s) {
  std::vector<ParameterError> mistakes;
  if (site.strong_m_s > 0.0 && !(site.median_m_s > 0.0 && site.strong_m_s > site.median_m_s)) {
    mistakes.push_back({"site_strong", fmt::format("is {}, with site_median {}; allowed: 0, or more than a "
                                                   "site_median that is above 0",
                                                   site.strong_m_s, site.median_m_s)});
  }
  if (ceiling_m_s > 0.0 && !(ceiling_most_m_s > ceiling_m_s)) {
    mistakes.push_back(
        {"ceiling_most", fmt::format("is {}; allowed: more than ceiling, which is {}", ceiling_most_m_s, ceiling_m_s)});
  }
  return mistakes;
}

}  // namespace

std::span<const Parameter> shaping_parameters() {
  return kShapingParameters;
}

Result<ShapingConfig, std::vector<ParameterError>> shaping_config_of(const ParameterValues& values,
                                                                     const WindConfig& wind) {
  const wind::shaping::SiteRange site{.median_m_s = values.number("site_median"),
                                      .strong_m_s = values.number("site_strong"),
                                      .most_gain = values.number("site_most_gain")};
  const double ceiling_m_s = values.number("ceiling");
  const double ceiling_most_m_s = values.number("ceiling_most");
  std::vector<ParameterError> mistakes = speed_mistakes(site, ceiling_m_s, ceiling_most_m_s);
  auto hours = OpeningHours::parse(values.text("hours"), values.text("zone"));
  if (!hours) mistakes.push_back(hours.error());
  if (!mistakes.empty()) return mistakes;

  ShapingConfig shaping{.settings = {.floor_m_s = values.number("floor"),
                                     .site = site,
                                     .site_memory_s = kSecondsPerDay * values.number("site_memory"),
                                     .over_s = values.number("over"),
                                     .gusts = values.number("gusts"),
                                     .ceiling = {},
                                     .closed_level = values.number("closed"),
                                     .fade_s = values.number("fade"),
                                     .turbulence_intensity = wind.default_turbulence_intensity,
                                     .length_m = wind.gust_length_m()},
                        .hours = *hours,
                        .site_file = values.text("site_file")};
  if (ceiling_m_s > 0.0) shaping.settings.ceiling = {.from_m_s = ceiling_m_s, .most_m_s = ceiling_most_m_s};
  return shaping;
}

}  // namespace yuragi::daemon::settings
