#include "simulators/core/common_options.hpp"

#include <utility>

#include "engine/base/duration.hpp"
#include "simulators/core/scenario_file.hpp"

namespace yuragi::simulators::core {

void CommonOptions::add_to(CLI::App& command) {
  command
      .add_option("--wind", wind,
                  "synthetic; or a recording FILE.windlog, played in a loop; or the wind of a scenario, FILE.toml")
      ->capture_default_str();
  command.add_option("--speed", synthetic.mean_speed_m_s, "mean of the synthetic wind, m/s")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command.add_option("--direction", synthetic.mean_direction_deg, "direction that the wind comes from, degrees")
      ->check(CLI::Range(0.0, 360.0))
      ->capture_default_str();
  command
      .add_option("--turbulence", synthetic.turbulence_intensity, "standard deviation of the wind, divided by its mean")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--seed", synthetic.seed, "the same seed gives the same wind and the same random faults")
      ->capture_default_str();
  command.add_option("--fault", faults,
                     "KIND@START+DURATION, such as silence@10+5 (seconds) or unplug@5min+30s; can be repeated. While "
                     "running, standard input takes: KIND [TIME], clear, help");
  command.add_option("--random-faults", random_faults_every_s, "one random fault in each period of this many seconds")
      ->check(CLI::Range(1.0, 1e6));
  command.add_option("--random-fault-duration", random_fault_s, "duration of each random fault, s")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  command.add_option("--duration", run.duration_s, "end after this time: 90 (seconds), 5min, 2h")
      ->type_name("TIME")
      ->transform(CLI::Validator(duration_to_seconds, ""))
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--verbose", run.verbose, "print a status line every second even without a terminal");
}

MeasuredWind CommonOptions::make_wind() const {
  if (wind == "synthetic") return MeasuredWind(play_synthetic_wind(synthetic));
  if (wind.ends_with(".toml")) return MeasuredWind(play_phases(read_scenario(wind).phases));
  return MeasuredWind(play_recorded_wind(wind));
}

Faults CommonOptions::make_faults(std::span<const FaultKind> known) const {
  Faults all(known);
  for (const std::string& text : faults) {
    const auto fault = all.parse(text);
    if (!fault) throw CLI::ValidationError("--fault", fault.error().message);
    all.add(*fault);
  }
  if (random_faults_every_s) {
    if (*random_faults_every_s <= random_fault_s) {
      throw CLI::ValidationError("--random-faults", "must be longer than --random-fault-duration");
    }
    all.add(RandomFaults{.every_s = *random_faults_every_s, .duration_s = random_fault_s, .seed = synthetic.seed});
  }
  return all;
}

void CommonOptions::run_simulator(Simulator& simulator) const {
  core::run(simulator, make_faults(simulator.known_faults()), run);
}

Address address_option(const std::string& option, const std::string& text) {
  const auto address = parse_address(text);
  if (!address) throw CLI::ValidationError(option, address.error().message + "; port 0 takes a free one");
  return *address;
}

}  // namespace yuragi::simulators::core
