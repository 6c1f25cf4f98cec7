#include "daemon/tools/doctor/doctor.hpp"

#include <algorithm>
#include <chrono>

#include "daemon/settings/secret_exposure.hpp"
#include "daemon/tools/doctor/company_probe.hpp"
#include "daemon/tools/doctor/judgements.hpp"
#include "daemon/tools/doctor/machine_probe.hpp"
#include "daemon/tools/doctor/rehearsal.hpp"
#include "daemon/tools/doctor/sensor_probe.hpp"

namespace yuragi::daemon::tools::doctor {
namespace {

constexpr auto kNetworkTimeout = std::chrono::seconds(2);

void append(std::vector<Finding>& all, std::vector<Finding> more) {
  for (Finding& finding : more) all.push_back(std::move(finding));
}

/// As the running daemon measures it, else one reading a second from each sensor.
double readings_per_s(const settings::Config& config, const std::optional<wire::Sensors>& running) {
  double rate_hz = 0.0;
  if (running) {
    for (const wire::SensorStatus& sensor : running->sensors)
      rate_hz += sensor.interval_s > 0.0 ? 1.0 / sensor.interval_s : 0.0;
  }
  return rate_hz > 0.0 ? rate_hz : static_cast<double>(config.sensors.size());
}

/// What is plugged in and cannot be opened, although no sensor of the configuration names it.
void add_other_devices(std::vector<Finding>& all, std::span<const sensors::DeviceFinding> plugged) {
  std::vector<std::string> reported;
  reported.reserve(all.size());
  for (const Finding& finding : all) reported.push_back(finding.text);
  for (const sensors::DeviceFinding& found : plugged) {
    if (found.device.trouble.empty()) continue;
    const bool is_reported = std::ranges::any_of(
        reported, [&](const std::string& text) { return text.find(found.device.what) != std::string::npos; });
    if (is_reported) continue;
    reported.push_back(found.device.what);
    all.push_back({Verdict::kWarning, "device", found.device.what + ": " + found.device.trouble, found.device.remedy});
  }
}

}  // namespace

std::vector<Finding> examine(const Examination& examination, const std::function<void(std::string_view)>& begin_step) {
  const auto begin = [&begin_step](std::string_view step) {
    if (begin_step) begin_step(step);
  };
  std::vector<Finding> all;
  ConfigFacts config_facts{.file = examination.config_file ? examination.config_file->string() : std::string(),
                           .error = examination.config_error};
  if (examination.config && examination.config_file)
    config_facts.exposed = settings::exposed_secrets(*examination.config, *examination.config_file);
  append(all, judge(config_facts));

  const settings::Config config = examination.config ? *examination.config : settings::default_config();
  std::optional<wire::Sensors> running;
  if (examination.daemon) running = examination.daemon->sensors;
  begin("the devices that are plugged in");
  const auto plugged = sensors::find_devices(drivers::sensor::driver_table());
  if (examination.config) {
    begin("the sensors' devices, up to 2 s for each that does not reply");
    for (const DeviceFacts& device : probe_devices(config, plugged, running, kNetworkTimeout))
      all.push_back(judge(device));
  }
  add_other_devices(all, plugged);
  begin("permissions, clock, disk and address");
  append(all, judge(probe_groups(needed_groups(config))));
  all.push_back(judge(probe_clock(config)));
  if (config.recording.file) all.push_back(judge(probe_disk(config.recording, readings_per_s(config, running))));

  const std::string daemon = examination.daemon ? examination.daemon->software : std::string();
  all.push_back(judge(probe_port(config.stream.listen, daemon)));
  if (config.wind.lead.is_in_company()) {
    begin("the servers of [wind] lead and follow, up to 2 s");
    for (const CompanyServerFacts& server : probe_company(config.wind.lead, kNetworkTimeout))
      all.push_back(judge(server));
  }
  begin("graphics, display and versions");
  const DisplayFacts display = probe_display();
  append(all, judge(display));
  append(all, judge(probe_versions(daemon, display.viewer)));
  append(all, judge(probe_limits(config)));
  if (const auto unit = installed_unit(kServiceUnit); unit && examination.config && examination.config_file) {
    begin("the next boot of the service");
    append(all,
           rehearse({.config = config, .config_file = *examination.config_file, .unit = *unit, .plugged = plugged}));
  }
  return all;
}

}  // namespace yuragi::daemon::tools::doctor
