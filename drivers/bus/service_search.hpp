#pragma once

#include <string>
#include <vector>

#include "drivers/bus/dns_message.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// Asks for services of a type ("_signalk-ws._tcp.local") by multicast DNS, or at one address, for that duration.
/// Returns each service once, with the announced address, or that of the sender. Fails like ask_networks().
Result<std::vector<AnnouncedService>, Failure> find_services(const std::string& type, const std::string& to,
                                                             std::uint16_t port, Nanoseconds duration);

}  // namespace yuragi::drivers::bus
