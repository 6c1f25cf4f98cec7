#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace yuragi::drivers::bus {

// Messages of DNS-based service discovery over multicast DNS (S. Cheshire and M. Krochmal, RFC 6762 and RFC 6763,
// 2013), made and taken apart by the resolver of the C library. A request from a port other than 5353 is answered to
// that port only (RFC 6762, sections 5.1 and 6.7), so that no service of this machine is needed.

inline constexpr const char* kMulticastDnsGroup = "224.0.0.251";

/// One announced service.
struct AnnouncedService {
  std::string name;  ///< of the instance, as announced: "weatherlinklive-700008"; printable, at most 63 characters
  std::string address = {};  ///< IPv4; empty: not in the message
  std::uint16_t port = 0;    ///< 0: not in the message

  bool operator==(const AnnouncedService&) const = default;
};

/// The question for services of a type ("_signalk-ws._tcp.local"), with the id 0: the WeatherLink Live answers no id
/// above 4 (drivers/SOURCES.md S9.20). Empty if the type is not a name. Thread-safe: yes.
std::vector<std::uint8_t> service_question(const std::string& type);

/// The services of that type in an answer; empty for bytes that are not an answer. At most 16 of one message.
/// Thread-safe: yes.
std::vector<AnnouncedService> services_in(std::span<const std::uint8_t> message, const std::string& type);

}  // namespace yuragi::drivers::bus
