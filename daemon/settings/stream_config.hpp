#pragma once

#include <cstddef>
#include <string>

#include "daemon/settings/control_permission.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::settings {

/// [stream]: where clients connect, and what they may do.
struct StreamConfig {
  std::string listen;  ///< HOST:PORT, see parse_address()
  std::size_t max_clients = 0;
  std::size_t max_clients_per_address = 0;  ///< of each other machine
  ControlPermission control =
      ControlPermission::kNobody;  ///< who may switch scenes, control recordings, see raw messages
};

/// From the values of stream_parameters(). An error names the key.
Result<StreamConfig, ParameterError> stream_config_of(const ParameterValues& values);

}  // namespace yuragi::daemon::settings
