#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/sensor_config.hpp"
#include "daemon/tools/acceptance/acceptance.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::acceptance {

// The wind that is simulated, without turbulence: values that every device can send exactly, also one that knows eight
// points of the compass.
inline constexpr double kSimulatedSpeed_m_s = 8.0;
inline constexpr double kSimulatedDirection_deg = 225.0;

/// The simulation of a configured sensor.
struct SimulationPlan {
  std::vector<std::string> arguments;  ///< of yuragi-sim, which listens at a free port of 127.0.0.1, or sends there
  settings::SensorConfig sensor;       ///< the configured one, except for the way to its device; without its port
  std::string_view port_key;           ///< which of its driver's values that is
  ExpectedWind expected;               ///< of its calibrated readings
};

/// Plans the simulation of a sensor, as its driver describes it (DriverDescription::simulated). Fails, in words for the
/// technician, if yuragi-sim cannot play it without special rights. Pure.
Result<SimulationPlan, Failure> plan_simulation(const settings::SensorConfig& sensor);

/// The plan's sensor with its device at this port.
settings::SensorConfig at_port(const SimulationPlan& plan, std::uint16_t port);

/// The port in the first line of a simulator ("listening on 127.0.0.1:4001"). Nullopt: there is none, or the line is
/// not complete yet.
std::optional<std::uint16_t> simulator_port(std::string_view output);

}  // namespace yuragi::daemon::tools::acceptance
