#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/parameter.hpp"

namespace yuragi::drivers::sensor {

/// How yuragi-sim plays the device of a sensor, for `yuragi accept`. What it has no option for is the caller's: how it
/// is started, and the wind.
struct SimulatedDevice {
  std::vector<std::string> arguments;  ///< of yuragi-sim: its subcommand, where it listens or sends to, what it plays
  ParameterValues values;              ///< the sensor's, except the connection to the device; without its port
  std::string_view port_key = "port";  ///< which of the values is the port that the simulator reports
  double north_offset_deg = 0.0;       ///< what the driver itself adds to directions
  double speed_step_m_s = 0.1;         ///< the device rounds to it; half of it would do, all leaves room for units
};

/// A device that listens at a free TCP port of this machine. `options`: of the subcommand.
SimulatedDevice simulated_server(std::string subcommand, ParameterValues values,
                                 const std::vector<std::string>& options = {});

/// The same of a driver with several transports, by TCP.
SimulatedDevice simulated_by_tcp(std::string subcommand, ParameterValues values,
                                 const std::vector<std::string>& options = {});

/// A device that sends to the port of this machine at which the sensor listens; the sensor hears this machine alone.
/// `option` takes the address.
SimulatedDevice simulated_sender(std::string subcommand, std::string option, ParameterValues values,
                                 const std::vector<std::string>& options = {});

}  // namespace yuragi::drivers::sensor
