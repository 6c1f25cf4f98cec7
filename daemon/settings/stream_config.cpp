#include "daemon/settings/stream_config.hpp"

#include <cstdint>

#include "engine/base/address.hpp"

namespace yuragi::daemon::settings {

Result<std::string, Failure> checked_address(const std::string& text) {
  if (const auto address = parse_address(text); !address) return address.error();
  return {boost::system::in_place_value, text};
}

const Fields<StreamConfig>& stream_fields() {
  static const Fields<StreamConfig> kFields{
      {{.name = "listen",
        .default_value = std::string("127.0.0.1:7410"),
        .help = "address and port that viewers connect to; 0.0.0.0:7410 accepts other machines, too",
        .change = KeyChange::kTakesRestart},
       &StreamConfig::listen,
       checked_address},
      {{.name = "max_clients",
        .default_value = std::int64_t{32},
        .min = 1,
        .max = 1000,
        .help = "simultaneous connections; more are refused. The last 4 (of fewer than 8: half of them) are for "
                "clients on this machine"},
       &StreamConfig::max_clients},
      {{.name = "max_clients_per_address",
        .default_value = std::int64_t{8},
        .min = 1,
        .max = 1000,
        .help = "simultaneous connections from each other machine; this machine has no such limit"},
       &StreamConfig::max_clients_per_address},
      {{.name = "control",
        .default_value = std::string("loopback"),
        .help = "clients that may control scenes and recordings (yuragi scene, yuragi player), have this file read "
                "again (yuragi reload), and see raw messages (yuragi sensors watch --raw): on this machine, "
                "anywhere, or nobody",
        .choices = kControlPermissionNames},
       &StreamConfig::control},
  };
  return kFields;
}

}  // namespace yuragi::daemon::settings
