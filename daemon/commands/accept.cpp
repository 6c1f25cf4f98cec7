// `yuragi accept`: the hand-over on site, from each device to the poses, with a page to sign.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <fstream>
#include <future>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/installation.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/commands/lock_recording.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/commands/simulator_process.hpp"
#include "daemon/sensing/system_clock.hpp"
#include "daemon/service/config_check.hpp"
#include "daemon/service/daemon_log.hpp"
#include "daemon/service/service.hpp"
#include "daemon/settings/standard_output.hpp"
#include "daemon/stream/stream_client.hpp"
#include "daemon/tools/acceptance/acceptance.hpp"
#include "daemon/tools/acceptance/sensor_measurement.hpp"
#include "daemon/tools/acceptance/simulated_sensor.hpp"
#include "daemon/tools/doctor/local_port.hpp"
#include "daemon/tools/doctor/machine_probe.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr auto kOwnConnectTimeout = std::chrono::seconds(10);
constexpr auto kOwnSilenceTimeout = std::chrono::seconds(5);
constexpr double kSetUp_s = 30.0;  ///< of the service, before it measures
constexpr double kNorthTime_s = 5.0;
constexpr double kMaxSimulated_s = 10.0;  ///< a constant wind counts as frozen after 30 s
constexpr double kPersonsTime_s = 3600.0;

struct AcceptOptions {
  std::optional<std::filesystem::path> config_file;
  std::string output = "acceptance.html";
  std::string site;
  double duration_s = 20.0;
  bool asks = false;
  bool is_real_only = false;
  bool is_simulated_only = false;
  bool as_json = false;
  bool force = false;
};

/// The configuration with one sensor alone, in which nothing but this sensor moves the scenes.
settings::Config with_one_sensor(settings::Config config, settings::SensorConfig sensor) {
  config.sensors = {std::move(sensor)};
  config.wind.fallback.reset();
  config.shaping.hours = {};  // a wall that is closed at this hour is still handed over
  config.shaping.site_file.clear();
  return config;
}

/// A daemon on a thread of its own, which ends with this object.
class OwnDaemon {
 public:
  OwnDaemon(const settings::Config& config, double longest_s)
      : service_(config, {.record = std::nullopt, .duration_s = longest_s}),
        end_(std::async(std::launch::async, [this] { service_.run(); })),
        client_(stream::Client::connect(config.stream.listen, kOwnConnectTimeout).value()) {
    // Its Hello comes when run() handles signals.
    const auto hello = client_.receive(kOwnConnectTimeout);
    is_running_ = hello.has_value();
    client_.subscribe({.poses = true, .sensors = true, .client = "accept"});
  }
  ~OwnDaemon() {
    // While run() goes on, it handles the signal.
    const bool goes_on = end_.valid() && end_.wait_for(std::chrono::seconds(0)) == std::future_status::timeout;
    if (is_running_ && goes_on) kill(getpid(), SIGTERM);
  }
  OwnDaemon(const OwnDaemon&) = delete;
  OwnDaemon& operator=(const OwnDaemon&) = delete;

  /// Passes incoming readings to the measurement for `time_s`, or until `is_enough`.
  template <class IsEnough>
  void measure(tools::acceptance::SensorMeasurement& measurement, double time_s, IsEnough is_enough) {
    const MonoTime end = clock_.now().mono + from_seconds(time_s);
    while (clock_.now().mono < end && !is_enough()) {
      const auto message = client_.receive(kOwnSilenceTimeout);
      if (message) {
        measurement.take(*message, clock_.now());
      } else if (message.error() != stream::End::kTimeout) {
        is_running_ = false;
        end_.get();  // throws what ended it
        throw ExitError(kExitUnavailable, "interrupted");
      }
    }
  }

 private:
  sensing::SystemClock clock_;
  service::Service service_;
  std::future<void> end_;
  stream::Client client_;
  bool is_running_ = false;
};

/// Asks the technician to hold the vane, and reads it; nullopt if there is no vane, or it is left out.
std::optional<tools::acceptance::NorthCheck> check_north(OwnDaemon& daemon,
                                                         tools::acceptance::SensorMeasurement& measurement,
                                                         const std::string& sensor) {
  if (!measurement.direction_deg()) return std::nullopt;
  fmt::print(stderr,
             "Hold the vane of {} so that it points to the north (wind from the north), then press Enter; s and\n"
             "Enter leaves it out: ",
             sensor);
  auto answer = std::async(std::launch::async, [] {
    std::string line;
    std::getline(std::cin, line);
    return line;
  });
  // Messages are read meanwhile: a client that does not read is disconnected.
  tools::acceptance::SensorMeasurement meanwhile(sensor);
  daemon.measure(meanwhile, kPersonsTime_s,
                 [&] { return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
  if (answer.get() == "s") return std::nullopt;
  tools::acceptance::SensorMeasurement held(sensor);
  daemon.measure(held, kNorthTime_s, [] { return false; });
  if (!held.direction_deg()) return std::nullopt;
  return tools::acceptance::NorthCheck{.sensor = sensor, .direction_deg = *held.direction_deg()};
}

void measure_sensor(tools::acceptance::Acceptance& acceptance, const settings::Config& config, std::size_t index,
                    const AcceptOptions& options) {
  const sensing::SystemClock clock;
  const std::string& name = config.sensors[index].name;
  fmt::print(stderr, "sensor {} of {}: {}, real\n", index + 1, config.sensors.size(), name);
  tools::acceptance::SensorMeasurement measurement(name);
  const double longest_s = kSetUp_s + 2.0 * options.duration_s + (options.asks ? kPersonsTime_s : 0.0);
  OwnDaemon daemon(with_one_sensor(config, config.sensors[index]), longest_s);
  daemon.measure(measurement, options.duration_s, [&] { return measurement.has_reading(); });
  if (measurement.has_reading()) daemon.measure(measurement, options.duration_s, [] { return false; });
  acceptance.sensors.push_back(measurement.result(clock.now()));
  if (!options.asks || !measurement.has_reading()) return;
  if (const auto check = check_north(daemon, measurement, name)) acceptance.north_checks.push_back(*check);
}

/// Measures a sensor with a simulated device, or returns the reason why it cannot be simulated.
tools::acceptance::SimulatedPart measure_simulated(const settings::Config& config, std::size_t index,
                                                   const AcceptOptions& options) {
  const sensing::SystemClock clock;
  const settings::SensorConfig& sensor = config.sensors[index];
  tools::acceptance::SimulatedPart part{.name = sensor.name, .driver = std::string(sensor.driver->name)};
  const auto plan = tools::acceptance::plan_simulation(sensor);
  if (!plan) {
    part.why_not = plan.error().message;
    return part;
  }
  const auto simulator = SimulatorProcess::start(plan->arguments);
  if (!simulator) {
    part.why_not = simulator.error().message;
    return part;
  }
  fmt::print(stderr, "sensor {} of {}: {}, simulated at 127.0.0.1:{}\n", index + 1, config.sensors.size(), sensor.name,
             simulator->port());
  tools::acceptance::SensorMeasurement measurement(sensor.name);
  OwnDaemon daemon(with_one_sensor(config, tools::acceptance::at_port(*plan, simulator->port())),
                   kSetUp_s + 2.0 * options.duration_s);
  daemon.measure(measurement, options.duration_s, [&] { return measurement.has_reading(); });
  if (measurement.has_reading())
    daemon.measure(measurement, std::min(options.duration_s, kMaxSimulated_s), [] { return false; });
  part.measured = measurement.result(clock.now());
  part.verdict = tools::acceptance::judge_simulated(*part.measured, plan->expected);
  return part;
}

/// Mean speeds of the sensors that measure speeds, without one of them.
std::vector<double> speeds_of_others(const tools::acceptance::Acceptance& acceptance, const settings::Config& config,
                                     std::size_t index) {
  std::vector<double> speeds_m_s;
  if (config.sensors[index].driver->is_relative) return speeds_m_s;
  for (std::size_t i = 0; i < acceptance.sensors.size(); ++i) {
    const auto& mean_m_s = acceptance.sensors[i].mean_speed_m_s;
    if (i != index && !config.sensors[i].driver->is_relative && mean_m_s) speeds_m_s.push_back(*mean_m_s);
  }
  return speeds_m_s;
}

void refuse_beside_a_daemon(const settings::Config& config) {
  bool is_in_use = false;
  tools::doctor::listen_trouble(config.stream.listen, is_in_use);
  if (!is_in_use) return;
  throw ExitError(kExitUnavailable,
                  fmt::format("a daemon runs at {} and uses the devices: stop it first, and start it again afterwards "
                              "(sudo systemctl stop yuragi)",
                              config.stream.listen));
}

void run_accept(const AcceptOptions& options) {
  if (options.asks && options.is_simulated_only)
    throw ExitError(kExitUsage, "--ask needs real vanes: remove --simulated-only");
  if (options.asks && isatty(STDIN_FILENO) == 0)
    throw ExitError(kExitUsage, "--ask needs a terminal, to ask the technician");
  const service::DaemonLog log(false);
  spdlog::set_level(spdlog::level::err);  // the messages of sensors are on the page
  const auto file = installed_config(options.config_file);
  const settings::Config config = configuration_of(file);
  service::check(config);
  const auto lock = lock_output(options.output);
  platform::OutputFile output(options.output, options.force);  // checked before the work
  refuse_beside_a_daemon(config);

  const tools::doctor::VersionFacts versions = tools::doctor::probe_versions("", std::nullopt);
  tools::acceptance::Acceptance acceptance{.site = options.site,
                                           .configuration = file ? file->string() : std::string(),
                                           .software = versions.program,
                                           .system = versions.system + ", " + versions.kernel,
                                           .begun = std::chrono::system_clock::now(),
                                           .duration_s = options.duration_s,
                                           .simulated = {},
                                           .sensors = {},
                                           .verdicts = {}};
  for (std::size_t i = 0; i < config.sensors.size() && !options.is_real_only; ++i)
    acceptance.simulated.push_back(measure_simulated(config, i, options));
  for (std::size_t i = 0; i < config.sensors.size() && !options.is_simulated_only; ++i)
    measure_sensor(acceptance, config, i, options);
  for (std::size_t i = 0; i < acceptance.sensors.size(); ++i) {
    acceptance.verdicts.push_back(
        tools::acceptance::judge(acceptance.sensors[i], speeds_of_others(acceptance, config, i)));
  }
  std::ofstream page(output.working_path(), std::ios::binary);
  page << tools::acceptance::acceptance_page(acceptance);
  page.close();
  if (!page) throw ExitError(kExitCannotCreate, options.output + ": cannot be written; is the disk full?");
  output.commit().value();
  if (options.as_json) {
    print_json(tools::acceptance::acceptance_json(acceptance));
  } else {
    settings::write_at_once(tools::acceptance::acceptance_text(acceptance));
  }
  fmt::print(stderr, "{}: {}\n", options.output,
             is_rehearsal(acceptance) ? "a rehearsal; for the hand-over run it again without --simulated-only"
                                      : "print it and sign it");
  if (outcome_of(acceptance) == tools::acceptance::Outcome::kFailed) throw ExitError(kExitAttention, "");
}

void add_accept(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "accept",
      "hand an installation over: each sensor from its device, simulated and real, to the poses, and a page to sign");
  command->footer(
      "Runs the configuration with each sensor alone, one after another, and measures at the end of the stream: do\n"
      "readings arrive, and are they used; how often; their range; do poses move; the time from a reading to the\n"
      "first pose that it moves. Mean speeds are compared with those of the other sensors. Nothing is recorded;\n"
      "opening hours and the fall-back recording are off. Stop the daemon first, because it uses the devices.\n"
      "Each sensor takes the time of --for, and up to as long again until its first reading.\n"
      "First each sensor on a line or in the network is simulated for --for, at most 10 s: yuragi-sim plays its\n"
      "device in a constant wind (8 m/s from 225 degrees), read with its entry except for address, station and,\n"
      "with nmea, talker and xdr_id. The calibrated speed and direction must be those of that wind: this proves\n"
      "configuration and software, not cables and device. A sensor that cannot be simulated, or for which yuragi-sim\n"
      "is missing, is listed with the reason, neither passed nor failed.\n"
      "With --ask the technician also holds each vane to the north (15 degrees are allowed).\n"
      "Failed: no reading, readings that are not used at the end, no frames, or poses that do not move. Remarks:\n"
      "readings that are synthetic, replayed or constant, 5 % of messages refused, 200 ms from reading to pose, a\n"
      "mean speed that is half or twice that of the others.\n"
      "Exit code 0: passed, with remarks at most; 1: failed; 69: a daemon runs; 73: the page cannot be written.\n"
      "--json: verdict (\"passed\", \"remark\" or \"failed\"), is_rehearsal (simulated devices only), site,\n"
      "configuration, software, system, begun, simulated and sensors (both with name, driver, verdict, remarks, state, "
      "readings,\n"
      "measured_s, first_reading_s, interval_s, least_speed_m_s, mean_speed_m_s, largest_speed_m_s, direction_deg,\n"
      "delays, median_delay_s, longest_delay_s, frames, moved_frames, largest_live_weight; if not simulated: name,\n"
      "driver, remarks, and verdict null) and north_checks (sensor, direction_deg, verdict). Unknown values are null.\n"
      "  sudo systemctl stop yuragi && sudo -u yuragi yuragi accept --site \"Museum, hall 2\" --out /tmp/hall-2.html");
  auto options = std::make_shared<AcceptOptions>();
  add_installation_config(*command, options->config_file);
  command->add_option("--out,-o", options->output, "the page to write")->type_name("FILE.html")->capture_default_str();
  command->add_option("--site", options->site, "the name of the site, for the page")->type_name("TEXT");
  command->add_option("--for", options->duration_s, "how long each sensor is measured: 90 (seconds), 2min (default 20)")
      ->type_name("TIME")
      ->transform(duration_in_seconds())
      ->check(CLI::Range(1.0, 3600.0));
  CLI::Option* real = command->add_flag("--real-only", options->is_real_only, "measure the real devices only");
  command
      ->add_flag("--simulated-only", options->is_simulated_only,
                 "a rehearsal: measure simulated devices only; nothing need be connected")
      ->excludes(real);
  command->add_flag("--ask", options->asks, "ask the technician to hold each vane to the north");
  add_json(*command, options->as_json);
  command->add_flag("--force", options->force, "overwrite the page");
  command->callback([options] { run_accept(*options); });
}

}  // namespace

extern const Command kAcceptCommand;
const Command kAcceptCommand{add_accept};

}  // namespace yuragi::daemon::commands
