#include "daemon/shaping/shaping_text.hpp"

#include <cmath>

#include <fmt/format.h>

#include "daemon/settings/duration_text.hpp"

namespace yuragi::daemon::shaping {

bool is_raised(const wind::shaping::WindShapingReport& report, double share) {
  return report.shaped_mean_m_s - report.site_gain * report.mean_m_s > share * report.shaped_mean_m_s;
}

std::string shaping_text(const wind::shaping::WindShapingReport& report,
                         const wind::shaping::WindShapingSettings& settings, const OpeningNews& opening) {
  std::string text;
  const auto add = [&text](const std::string& part) { text.append(text.empty() ? "" : "; ").append(part); };

  if (settings.site.median_m_s > 0.0) {
    add(report.known_s > 0.0
            ? fmt::format("site gain {:.2f} (in {} median {:.1f}, strong {:.1f} m/s)", report.site_gain,
                          settings::duration_text(report.known_s), report.median_m_s, report.strong_m_s)
            : fmt::format("site gain {:.2f} (nothing is known of the site yet)", report.site_gain));
  }
  if (settings.floor_m_s > 0.0 && is_raised(report)) {
    add(fmt::format("floor: raised {:.1f} to {:.1f} m/s", report.site_gain * report.mean_m_s, report.shaped_mean_m_s));
  }
  if (std::abs(report.gusts - 1.0) > 0.005) add(fmt::format("gusts {:.2f} times the real ones", report.gusts));
  if (opening.has_hours) {
    std::string hours = opening.is_open ? "open" : "closed";
    if (!opening.until.empty()) hours += " " + opening.until;
    // During the change, and if closing leaves a part of the wind, that part is named.
    const double target = opening.is_open ? 1.0 : settings.closed_level;
    if (std::abs(report.opening - target) > 0.005) hours += opening.is_open ? ", fading in" : ", fading out";
    if (std::abs(report.opening - (opening.is_open ? 1.0 : 0.0)) > 0.005) {
      hours += fmt::format(": {:.0f} % of the wind", 100.0 * report.opening);
    }
    add(hours);
  }
  if (report.ceiling_gain < 0.995) {
    add(fmt::format("ceiling: {:.1f} limited to {:.1f} m/s", report.speed_m_s, report.ceiling_gain * report.speed_m_s));
  }
  return text;
}

}  // namespace yuragi::daemon::shaping
