#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/state/json_value.hpp"
#include "daemon/tools/acceptance/acceptance.hpp"
#include "daemon/tools/report/report_text.hpp"

namespace yuragi::daemon::tools::acceptance {
namespace {

using nlohmann::ordered_json;
using state::json_or_null;

std::string number(const std::optional<double>& value, double factor = 1.0) {
  return value ? fmt::format("{:.2f}", factor * *value) : "-";
}

std::string sensor_row(const SensorMeasured& sensor, const SensorVerdict& verdict, std::string_view part) {
  const double interval_s = sensor.status.interval_s;
  std::string text =
      fmt::format("{:<14} {:<8} {:<9} {:>9} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9}\n", sensor.status.name,
                  name_of(verdict.outcome), part, sensor.status.readings, interval_s > 0.0 ? number(interval_s) : "-",
                  number(sensor.least_speed_m_s), number(sensor.mean_speed_m_s), number(sensor.largest_speed_m_s),
                  number(sensor.median_delay_s, 1e3), number(sensor.longest_delay_s, 1e3));
  for (const std::string& remark : verdict.remarks) text += fmt::format("  - {}\n", remark);
  return text;
}

ordered_json sensor_json(const SensorMeasured& sensor, const SensorVerdict& verdict) {
  ordered_json json = {{"name", sensor.status.name},
                       {"driver", sensor.status.driver},
                       {"verdict", name_of(verdict.outcome)},
                       {"remarks", verdict.remarks},
                       {"state", name_of(sensor.status.state)},
                       {"readings", sensor.status.readings},
                       {"measured_s", sensor.measured_s},
                       {"first_reading_s", json_or_null(sensor.first_reading_s)},
                       {"interval_s", nullptr},
                       {"least_speed_m_s", json_or_null(sensor.least_speed_m_s)},
                       {"mean_speed_m_s", json_or_null(sensor.mean_speed_m_s)},
                       {"largest_speed_m_s", json_or_null(sensor.largest_speed_m_s)},
                       {"direction_deg", json_or_null(sensor.status.direction_deg)},
                       {"delays", sensor.delays},
                       {"median_delay_s", json_or_null(sensor.median_delay_s)},
                       {"longest_delay_s", json_or_null(sensor.longest_delay_s)},
                       {"frames", sensor.frames},
                       {"moved_frames", sensor.moved_frames},
                       {"largest_live_weight", sensor.largest_live_weight}};
  if (sensor.status.interval_s > 0.0) json["interval_s"] = sensor.status.interval_s;
  return json;
}

}  // namespace

std::string acceptance_text(const Acceptance& acceptance) {
  std::string text = fmt::format("{:<14} {:<8} {:<9} {:>9} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9}\n", "sensor", "verdict",
                                 "device", "readings", "every s", "least", "mean", "most m/s", "delay ms", "most ms");
  for (std::size_t i = 0; i < std::max(acceptance.simulated.size(), acceptance.sensors.size()); ++i) {
    if (i < acceptance.simulated.size()) {
      const SimulatedPart& part = acceptance.simulated[i];
      text += part.measured
                  ? sensor_row(*part.measured, part.verdict, "simulated")
                  : fmt::format("{:<14} {:<8} simulated\n  - not simulated: {}\n", part.name, "-", part.why_not);
    }
    if (i < acceptance.sensors.size()) text += sensor_row(acceptance.sensors[i], acceptance.verdicts[i], "real");
  }
  for (const NorthCheck& check : acceptance.north_checks) {
    text += fmt::format("north of {}: it read {:.0f} degrees: {}\n", check.sensor, check.direction_deg,
                        name_of(is_passed(check) ? Outcome::kPassed : Outcome::kFailed));
  }
  return text + fmt::format("{}: {}\n",
                            is_rehearsal(acceptance) ? "rehearsal with simulated devices (not a hand-over: no real "
                                                       "device was measured)"
                                                     : "hand-over",
                            name_of(outcome_of(acceptance)));
}

ordered_json acceptance_json(const Acceptance& acceptance) {
  ordered_json simulated = ordered_json::array();
  for (const SimulatedPart& part : acceptance.simulated) {
    if (part.measured) {
      simulated.push_back(sensor_json(*part.measured, part.verdict));
    } else {
      simulated.push_back({{"name", part.name},
                           {"driver", part.driver},
                           {"verdict", nullptr},
                           {"remarks", {"not simulated: " + part.why_not}}});
    }
  }
  ordered_json all = ordered_json::array();
  for (std::size_t i = 0; i < acceptance.sensors.size(); ++i)
    all.push_back(sensor_json(acceptance.sensors[i], acceptance.verdicts[i]));
  ordered_json north = ordered_json::array();
  for (const NorthCheck& check : acceptance.north_checks) {
    north.push_back({{"sensor", check.sensor},
                     {"direction_deg", check.direction_deg},
                     {"verdict", name_of(is_passed(check) ? Outcome::kPassed : Outcome::kFailed)}});
  }
  return {{"verdict", name_of(outcome_of(acceptance))},
          {"is_rehearsal", is_rehearsal(acceptance)},
          {"site", acceptance.site},
          {"configuration", acceptance.configuration},
          {"software", acceptance.software},
          {"system", acceptance.system},
          {"begun", report::utc_text(acceptance.begun)},
          {"simulated", simulated},
          {"sensors", all},
          {"north_checks", north}};
}

}  // namespace yuragi::daemon::tools::acceptance
