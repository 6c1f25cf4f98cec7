#include "daemon/settings/shaping_config.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings {
namespace {

using wind::shaping::SiteRange;
using wind::shaping::SoftCeiling;
using wind::shaping::WindShapingSettings;

/// [shaping] as it is written.
struct ShapingTable {
  ShapingConfig shaping;
  std::string hours;
  std::string zone;
};

auto of_settings(auto member) {
  return member_of(&ShapingTable::shaping, &ShapingConfig::settings, member);
}
auto of_site(auto member) {
  return member_of(&ShapingTable::shaping, &ShapingConfig::settings, &WindShapingSettings::site, member);
}
auto of_ceiling(auto member) {
  return member_of(&ShapingTable::shaping, &ShapingConfig::settings, &WindShapingSettings::ceiling, member);
}

double seconds_of_days(double days) {
  constexpr double kSecondsPerDay = 86400.0;
  return kSecondsPerDay * days;
}

const Fields<ShapingTable>& shaping_fields() {
  static const Fields<ShapingTable> kFields{
      {{.name = "floor",
        .unit = "m/s",
        .default_value = 0.0,
        .min = 0.0,
        .max = 10.0,
        .help = "least mean speed: a weaker wind is slowly raised to it, with its gusts; 0: none"},
       of_settings(&WindShapingSettings::floor_m_s)},
      {{.name = "site_median",
        .unit = "m/s",
        .default_value = 0.0,
        .min = 0.0,
        .max = 30.0,
        .help = "speed to which a slow gain scales the site's median wind; 0: no site gain"},
       of_site(&SiteRange::median_m_s)},
      {{.name = "site_strong",
        .unit = "m/s",
        .default_value = 0.0,
        .min = 0.0,
        .max = 40.0,
        .help = "speed to which the site's strong wind (95th percentile) is scaled; 0: the gain of the median applies"},
       of_site(&SiteRange::strong_m_s)},
      {{.name = "site_most_gain",
        .default_value = 3.0,
        .min = 1.0,
        .max = 10.0,
        .help = "the largest site gain; the smallest is 1 over this"},
       of_site(&SiteRange::most_gain)},
      {{.name = "site_memory",
        .unit = "days",
        .default_value = 7.0,
        .min = 0.1,
        .max = 365.0,
        .help = "memory of the site's wind for these; the gain starts at 1 and takes effect over the first 6 hours"},
       of_settings(&WindShapingSettings::site_memory_s),
       seconds_of_days},
      {{.name = "site_file",
        .default_value = std::string(""),
        .help = "file that keeps this memory and the fit of the site's gusts (site_octaves of [wind]) over a "
                "restart; empty: both start anew",
        .change = KeyChange::kTakesRestart},
       [](ShapingTable & table) -> auto& {return table.shaping.site_file;
}
}  // namespace
,
    {{.name = "over",
      .unit = "s",
      .default_value = 120.0,
      .min = 10.0,
      .max = 3600.0,
      .help = "time in which floor and site gain follow the mean wind"},
     of_settings(&WindShapingSettings::over_s)},
    {{.name = "gusts",
      .default_value = 1.0,
      .min = 0.0,
      .max = 3.0,
      .help = "strength of gusts and lulls relative to the real ones: 0: steady wind, 1: unchanged, 2: twice "
              "as strong; the mean speed is unchanged"},
     of_settings(&WindShapingSettings::gusts)},
    {{.name = "ceiling",
      .unit = "m/s",
      .default_value = 17.0,
      .min = 0.0,
      .max = 75.0,
      .help = "speed above which the wind is compressed; 0: never"},
     of_ceiling(&SoftCeiling::from_m_s)},
    {{.name = "ceiling_most",
      .unit = "m/s",
      .default_value = 25.0,
      .min = 1.0,
      .max = 100.0,
      .help = "limit that the compressed speed approaches; must be above ceiling"},
     of_ceiling(&SoftCeiling::most_m_s)},
    {{.name = "hours",
      .default_value = std::string(""),
      .help = "opening hours in local time, \"10:00-18:00\" or \"Tue-Sun 10:00-18:00, Thu 18:00-21:00\"; "
              "outside of them the wind fades out; empty: always open"},
     &ShapingTable::hours},
    {{.name = "zone",
      .default_value = std::string(""),
      .help = "time zone of the hours, and of the cameras' times: \"Europe/Berlin\"; empty: that of this machine"},
     &ShapingTable::zone},
    {{.name = "closed",
      .default_value = 0.0,
      .min = 0.0,
      .max = 1.0,
      .help = "part of the wind that remains when closed; 0: calm"},
     of_settings(&WindShapingSettings::closed_level)},
    {{.name = "fade",
      .unit = "s",
      .default_value = 300.0,
      .min = 1.0,
      .max = 7200.0,
      .help = "duration of the fade between open and closed, from the opening or closing time on"},
     of_settings(&WindShapingSettings::fade_s)},
    {{.name = "norm_speed",
      .unit = "m/s",
      .default_value = 12.0,
      .min = 0.5,
      .max = 60.0,
      .help = "speed at which the value `norm` that feeds send is 1, as long as the site's winds are not known"},
     member_of(&ShapingTable::shaping, &ShapingConfig::norm_speed_m_s)},
};  // namespace yuragi::daemon::settings
return kFields;
}

/// The contradictions among the speeds of site gain and ceiling.
std::vector<ParameterError> speed_mistakes(const SiteRange& site, const SoftCeiling& ceiling) {
  std::vector<ParameterError> mistakes;
  if (site.strong_m_s > 0.0 && !(site.median_m_s > 0.0 && site.strong_m_s > site.median_m_s)) {
    mistakes.push_back({"site_strong", fmt::format("is {}, with site_median {}; allowed: 0, or more than "
                                                   "site_median, if that is above 0",
                                                   site.strong_m_s, site.median_m_s)});
  }
  if (ceiling.from_m_s > 0.0 && !(ceiling.most_m_s > ceiling.from_m_s)) {
    mistakes.push_back({"ceiling_most", fmt::format("is {}; allowed: more than ceiling, which is {}", ceiling.most_m_s,
                                                    ceiling.from_m_s)});
  }
  return mistakes;
}

}  // namespace

std::span<const Parameter> shaping_parameters() {
  return shaping_fields().parameters();
}

std::vector<ParameterError> fill_shaping(ShapingConfig& shaping, const ParameterValues& values,
                                         const WindConfig& wind) {
  ShapingTable table;
  std::vector<ParameterError> errors = shaping_fields().fill(table, values.all());
  shaping = std::move(table.shaping);
  WindShapingSettings& settings = shaping.settings;
  for (ParameterError& mistake : speed_mistakes(settings.site, settings.ceiling)) errors.push_back(std::move(mistake));
  if (settings.ceiling.from_m_s == 0.0) settings.ceiling = {};
  settings.turbulence_intensity = wind.default_turbulence_intensity;
  settings.length_m = wind.gust_length_m();
  if (auto hours = OpeningHours::parse(table.hours, table.zone)) {
    shaping.hours = *hours;
  } else {
    errors.push_back(hours.error());
  }
  return errors;
}

}  // namespace yuragi::daemon::settings
