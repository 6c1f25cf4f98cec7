#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace yuragi::daemon::feeds {

/// The UUID by which receivers of E1.31 tell sources apart (its CID).
using ComponentId = std::array<std::uint8_t, 16>;

/// The same for the same machine and feed at every start: a UUID of version 5 (RFC 4122 4.3), of which the machine's
/// identifier cannot be derived. Pure.
ComponentId component_id_of(std::string_view machine, std::string_view feed);

/// /etc/machine-id; the host's name if there is none.
std::string machine_id();

}  // namespace yuragi::daemon::feeds
