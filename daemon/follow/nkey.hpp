#pragma once

#include <optional>
#include <string>

#include "engine/base/secret.hpp"

namespace yuragi::daemon::follow {

/// Returns the public nkey ("U...") of the seed of a user ("SU..."), or nullopt if the seed is invalid. An nkey is a
/// key of Ed25519 in base32 (RFC 4648, without padding), with a prefix for its kind and a CRC-16/XMODEM, low byte
/// first. Thread-safe: yes.
std::optional<std::string> public_nkey(const Secret& seed);

}  // namespace yuragi::daemon::follow
