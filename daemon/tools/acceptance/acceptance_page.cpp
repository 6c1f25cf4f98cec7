#include <algorithm>

#include <fmt/format.h>

#include "daemon/settings/duration_text.hpp"
#include "daemon/tools/acceptance/acceptance.hpp"
#include "daemon/tools/report/page_writer.hpp"
#include "daemon/tools/report/report_style.hpp"
#include "daemon/tools/report/report_text.hpp"

namespace yuragi::daemon::tools::acceptance {
namespace {

using report::page_text;

/// Beside that of reports: lines to write on.
constexpr std::string_view kSigningStyle = R"css(
.sign { display: grid; grid-template-columns: 1fr 1fr; gap: 2.5rem 2rem; margin-top: 3rem; break-inside: avoid; }
.sign div { border-top: 1px solid var(--ink); padding-top: .2rem; color: var(--quiet); font-size: .85rem; }
.failed { color: #b00020; font-weight: 600; } .remark { font-weight: 600; }
)css";

std::string cell(const std::optional<double>& value, std::string_view unit, double factor = 1.0) {
  return value ? fmt::format("{:.2f} {}", factor * *value, unit) : "–";
}

std::string outcome_cell(Outcome outcome) {
  return fmt::format("<span class=\"{0}\">{0}</span>", name_of(outcome));
}

std::string remarks_cell(const std::string& device, const std::vector<std::string>& remarks) {
  std::string cell;
  for (const std::string& remark : remarks) cell += fmt::format("{}: {}<br>", device, page_text(remark));
  return cell;
}

/// Of each sensor: simulated, and real.
void add_verdicts(report::PageWriter& page, const Acceptance& acceptance) {
  page.add(
      "<h2>Sensors</h2>\n<table><thead><tr><th>Sensor</th><th>Driver</th><th>Simulated</th><th>Real</th>"
      "<th>Remarks</th></tr></thead><tbody>\n");
  for (std::size_t i = 0; i < std::max(acceptance.simulated.size(), acceptance.sensors.size()); ++i) {
    std::string name;
    std::string driver;
    std::string simulated = "–";
    std::string real = "–";
    std::string remarks;
    if (i < acceptance.simulated.size()) {
      const SimulatedPart& part = acceptance.simulated[i];
      name = part.name;
      driver = part.driver;
      if (part.measured) simulated = outcome_cell(part.verdict.outcome);
      remarks += part.measured ? remarks_cell("simulated", part.verdict.remarks)
                               : remarks_cell("not simulated", {part.why_not});
    }
    if (i < acceptance.sensors.size()) {
      name = acceptance.sensors[i].status.name;
      driver = acceptance.sensors[i].status.driver;
      real = outcome_cell(acceptance.verdicts[i].outcome);
      remarks += remarks_cell("real", acceptance.verdicts[i].remarks);
    }
    page.add("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", page_text(name), page_text(driver),
             simulated, real, remarks.empty() ? "–" : remarks);
  }
  page.add("</tbody></table>\n");
}

void add_figures(report::PageWriter& page, const SensorMeasured& sensor, std::string_view device) {
  page.add("<h3>{}, {}</h3>\n<table><tbody>\n", page_text(sensor.status.name), device);
  page.row("First reading after it was opened", cell(sensor.first_reading_s, "s"));
  page.row("Readings", fmt::format("{} in {}, {} messages from the device", sensor.status.readings,
                                   settings::duration_text(sensor.measured_s), sensor.status.frames));
  page.row("Interval between readings",
           sensor.status.interval_s > 0.0 ? fmt::format("{:.2f} s", sensor.status.interval_s) : "–");
  page.row("Speed: least, mean, most",
           fmt::format("{}, {}, {}", cell(sensor.least_speed_m_s, "m/s"), cell(sensor.mean_speed_m_s, "m/s"),
                       cell(sensor.largest_speed_m_s, "m/s")));
  page.row("Direction at the end", sensor.status.direction_deg
                                       ? fmt::format("from {:.0f}°, {}", *sensor.status.direction_deg,
                                                     report::compass_text(*sensor.status.direction_deg))
                                       : "none");
  page.row("From a reading to the pose that it moves: median, longest",
           fmt::format("{}, {} ({} timed)", cell(sensor.median_delay_s, "ms", 1e3),
                       cell(sensor.longest_delay_s, "ms", 1e3), sensor.delays));
  page.row("Frames, and of these with moving poses", fmt::format("{}, {}", sensor.frames, sensor.moved_frames));
  page.row("Largest part in the wind of the scenes", fmt::format("{:.0f} %", 100.0 * sensor.largest_live_weight));
  page.add("</tbody></table>\n");
}

}  // namespace

std::string acceptance_page(const Acceptance& acceptance) {
  report::PageWriter page;
  const std::string_view title = is_rehearsal(acceptance) ? "Rehearsal" : "Hand-over";
  page.add(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{5} {0}</title>\n<style>{1}{2}</style>\n</head>\n"
      "<body>\n<h1>{5}{3}{0}</h1>\n<p class=\"lead\">{4}</p>\n<table><tbody>\n",
      page_text(acceptance.site), report::kReportStyle, kSigningStyle, acceptance.site.empty() ? "" : ": ",
      (is_rehearsal(acceptance) ? "With simulated devices only; no real device was measured. This is not a hand-over: "
                                : "") +
          outcome_cell(outcome_of(acceptance)),
      title);
  page.row("Date", report::utc_text(acceptance.begun) + "<br>" + report::local_text(acceptance.begun));
  page.row("Program", page_text(acceptance.software));
  page.row("System", page_text(acceptance.system));
  page.row("Configuration",
           page_text(acceptance.configuration.empty() ? "the built-in one" : acceptance.configuration));
  page.row("Measured", fmt::format("each sensor by itself, from its device to the poses of all scenes, {}",
                                   settings::duration_text(acceptance.duration_s)));
  page.add("</tbody></table>\n");
  add_verdicts(page, acceptance);
  if (!acceptance.north_checks.empty()) {
    page.add("<h2>Vanes held to the north</h2>\n<table><tbody>\n");
    for (const NorthCheck& check : acceptance.north_checks) {
      page.row(page_text(check.sensor),
               fmt::format("read {:.0f}°: {}", check.direction_deg,
                           outcome_cell(is_passed(check) ? Outcome::kPassed : Outcome::kFailed)));
    }
    page.add("</tbody></table>\n");
  }
  page.add("<h2>Figures</h2>\n");
  for (std::size_t i = 0; i < std::max(acceptance.simulated.size(), acceptance.sensors.size()); ++i) {
    if (i < acceptance.simulated.size() && acceptance.simulated[i].measured)
      add_figures(page, *acceptance.simulated[i].measured, "simulated");
    if (i < acceptance.sensors.size()) add_figures(page, acceptance.sensors[i], "real");
  }
  if (!is_rehearsal(acceptance)) {
    page.add(
        "<div class=\"sign\"><div>handed over by (name)</div><div>taken over by (name)</div>"
        "<div>place, date, signature</div><div>place, date, signature</div></div>\n");
  }
  page.add(
      "<footer>Made by yuragi accept, {}. Passed: the sensor's readings come, are used, and move the poses. Remark: "
      "look at it. Failed: it does not work. The delay is that from a reading's time stamp to the frame that it moves "
      "first, in a client's hand, to within one tick. Speeds are of the readings seen twice a second. Simulated: by "
      "yuragi-sim with a known wind, in place of the device, which proves configuration and "
      "software.{}</footer>\n</body>\n</html>\n",
      page_text(acceptance.software),
      acceptance.simulated.empty() ? " The sensors were not simulated beforehand."
      : acceptance.sensors.empty() ? " The real devices were not measured."
                                   : "");
  return page.take();
}

}  // namespace yuragi::daemon::tools::acceptance
