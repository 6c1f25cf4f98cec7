#pragma once

#include <cstddef>
#include <string>

#include "daemon/settings/control_permission.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings {

/// [stream]: where clients connect, and what they may do.
struct StreamConfig {
  std::string listen;  ///< HOST:PORT, see parse_address()
  std::size_t max_clients = 0;
  std::size_t max_clients_per_address = 0;  ///< of each other machine
  ControlPermission control =
      ControlPermission::kNobody;  ///< who may switch scenes, control recordings, see raw messages
};

const Fields<StreamConfig>& stream_fields();

/// Returns "HOST:PORT" as it is, or why it is none (parse_address()).
Result<std::string, Failure> checked_address(const std::string& text);

}  // namespace yuragi::daemon::settings
