#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/base/address.hpp"
#include "simulators/core/played_wind.hpp"
#include "simulators/core/simulator.hpp"

namespace yuragi::simulators::core {

/// The options that every simulator has: the wind that it plays, the faults, and for how long it runs.
struct CommonOptions {
  std::string wind = "synthetic";
  wind::turbulence::SyntheticWindSettings synthetic;
  std::vector<std::string> faults;
  std::optional<double> random_faults_every_s;
  double random_fault_s = 5.0;
  RunOptions run;

  void add_to(CLI::App& command);

  /// The configured wind. Throws std::runtime_error if the recording cannot be played.
  MeasuredWind make_wind() const;

  /// The configured faults, which must be among those that are known. Throws CLI::ValidationError for any other.
  Faults make_faults(std::span<const FaultKind> known) const;

  /// Runs the simulator with the configured faults. Throws CLI::ValidationError for one that it cannot play.
  void run_simulator(Simulator& simulator) const;
};

/// The value of an option that takes HOST:PORT. Throws CLI::ValidationError, naming `option`.
Address address_option(const std::string& option, const std::string& text);

}  // namespace yuragi::simulators::core
