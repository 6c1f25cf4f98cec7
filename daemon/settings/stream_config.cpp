#include "daemon/settings/stream_config.hpp"

#include "engine/base/address.hpp"

namespace yuragi::daemon::settings {

Result<StreamConfig, ParameterError> stream_config_of(const ParameterValues& values) {
  const std::string& listen = values.text("listen");
  if (const auto address = parse_address(listen); !address) return ParameterError{"listen", address.error().message};
  return StreamConfig{.listen = listen,
                      .max_clients = static_cast<std::size_t>(values.integer("max_clients")),
                      .max_clients_per_address = static_cast<std::size_t>(values.integer("max_clients_per_address")),
                      .control = control_permission_named(values.text("control"))};
}

}  // namespace yuragi::daemon::settings
