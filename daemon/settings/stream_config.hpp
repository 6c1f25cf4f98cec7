#pragma once

#include <cstddef>
#include <string>

#include "daemon/settings/control_permission.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi {

/// [stream]: where clients connect, and what they may do.
struct StreamConfig {
  std::string listen;  ///< HOST:PORT, an address as parse_address() takes it
  std::size_t max_clients = 0;
  ControlPermission control = ControlPermission::kNobody;  ///< who may switch scenes and control recordings
};

/// Of the values of stream_parameters(). The error names the key that it is about.
Result<StreamConfig, ParameterError> stream_config_of(const ParameterValues& values);

}  // namespace yuragi
