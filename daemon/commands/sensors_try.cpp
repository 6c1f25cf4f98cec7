// `yuragi sensors try`: reads sensors that are not yet configured for a short time, without the daemon.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/commands/sensors.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/sensing/system_clock.hpp"
#include "daemon/service/daemon_log.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/settings/standard_output.hpp"
#include "daemon/state/sensor_json.hpp"
#include "daemon/tools/sensors/sensor_table.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr const char* kStandardInput = "/dev/stdin";
constexpr auto kStep = std::chrono::milliseconds(50);
constexpr auto kTableInterval = std::chrono::milliseconds(500);
/// After the first readings of all, so that a person sees them change.
constexpr auto kShownLive = std::chrono::seconds(3);

struct TryOptions {
  std::filesystem::path file;
  double duration_s = 60.0;
  bool as_json = false;
};

bool is_read(const wire::SensorStatus& sensor) {
  return sensor.readings > 0;
}

void show(const wire::Sensors& sensors, bool as_json) {
  if (as_json) {
    print_json_line(state::sensors_json(sensors)["sensors"]);
  } else {
    settings::write_at_once(tools::sensors::sensor_table(sensors) + "\n");
  }
  std::fflush(stdout);
}

/// Reads them until all have sent readings for a while, or the time is over. Returns their last states.
wire::Sensors read_sensors(const settings::Config& config, const TryOptions& options) {
  const sensing::SystemClock clock;
  sensing::SensorHub hub(config, clock, sensing::make_gust_noise(config));
  const MonoTime end = clock.now().mono + from_seconds(options.duration_s);
  MonoTime next_table = clock.now().mono + kTableInterval;
  std::optional<MonoTime> enough;
  wire::Sensors sensors;
  while (clock.now().mono < std::min(end, enough.value_or(end))) {
    std::this_thread::sleep_for(kStep);
    sensors.wind = hub.advance();
    sensors.sensors = hub.status();
    if (!enough && std::ranges::all_of(sensors.sensors, is_read)) enough = clock.now().mono + kShownLive;
    if (clock.now().mono < next_table) continue;
    next_table += kTableInterval;
    show(sensors, options.as_json);
  }
  return sensors;
}

void try_sensors(const TryOptions& options) {
  const service::DaemonLog log(false);
  spdlog::set_level(spdlog::level::err);  // the table shows the rest
  const std::filesystem::path file = options.file == "-" ? kStandardInput : options.file;
  const settings::Config config =
      settings::parse_config(settings::read_config_text(file), options.file == "-" ? "stdin" : file.string());
  const wire::Sensors sensors = read_sensors(config, options);
  std::string silent;
  for (const wire::SensorStatus& sensor : sensors.sensors) {
    if (!is_read(sensor))
      silent += fmt::format("{}{}: no reading: {}", silent.empty() ? "" : "\n", sensor.name, sensor.state_reason);
  }
  if (!silent.empty()) throw ExitError(kExitUnavailable, silent);
}

}  // namespace

void add_sensors_try(CLI::App& sensors) {
  CLI::App* command = sensors.add_subcommand("try", "read the sensors of a file for a short time, without the daemon");
  command->footer(
      "Reads each [[sensor]] of FILE until it has sent readings for 3 s, or the time is over, and shows a table twice "
      "a\n"
      "second. A device that only one program can open must not be the running daemon's. Nothing is recorded.\n"
      "Exit code 0: each has sent a reading; 69: one has not, with the reason.\n"
      "  printf '[[sensor]]\\ndriver = \"nmea\"\\ndevice = \"/dev/ttyUSB0\"\\n' | yuragi sensors try -\n"
      "--json: a list of sensors a line, as `yuragi sensors watch --json` has it.");
  auto options = std::make_shared<TryOptions>();
  command->add_option("file", options->file, "a configuration; -: standard input")->required()->type_name("FILE");
  command->add_option("--duration", options->duration_s, "end after this time at the latest: 90 (seconds), 5min")
      ->type_name("TIME")
      ->transform(duration_in_seconds())
      ->check(CLI::Range(0.1, 3600.0));
  add_json(*command, options->as_json);
  command->callback([options] { try_sensors(*options); });
}

}  // namespace yuragi::daemon::commands
