#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulators/core/wind_phases.hpp"

namespace yuragi::simulators::core {

/// One simulated device of a scenario.
struct ScenarioDevice {
  std::string name;
  std::string simulate;             ///< the arguments after `yuragi-sim` on a command line
  std::vector<std::string> faults;  ///< as for --fault
};

/// A rehearsal: a wind by time, and devices with their faults by time.
struct Scenario {
  std::optional<double> duration_s;  ///< nullopt: until it is stopped
  std::vector<WindPhase> phases;     ///< as play_phases() wants them
  std::vector<ScenarioDevice> devices;
};

/// Reads a scenario (TOML). Recordings are looked for beside the file. Throws std::runtime_error for a file that cannot
/// be read, and for what is wrong in it: FILE:LINE:COLUMN, the key, and what is allowed.
Scenario read_scenario(const std::filesystem::path& file);

}  // namespace yuragi::simulators::core
