#include "daemon/settings/shaping_config.hpp"

#include <utility>

#include <fmt/format.h>

namespace yuragi::daemon::settings {
namespace {

constexpr double kSecondsPerDay = 86400.0;

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
