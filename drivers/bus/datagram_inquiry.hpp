#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// A question to all devices in the local networks, by UDP over IPv4.
struct DatagramInquiry {
  std::vector<std::uint8_t> question;
  std::uint16_t port = 0;
  /// The one address that is asked, or a multicast group, asked on each interface; empty: the broadcast address of each
  /// interface.
  std::string to = {};
  Nanoseconds duration = std::chrono::seconds(5);  ///< time in which answers are accepted
};

struct DatagramAnswer {
  std::vector<std::uint8_t> bytes;
  std::string sender;  ///< its address

  bool operator==(const DatagramAnswer&) const = default;
};

/// Asks three times within the first three seconds, because datagrams get lost, from a port of its own, and takes the
/// replies to that port: each once, at most 1000 of them. Requests do not leave the local network (a time to live of
/// 1), unless they are to one address. Waits for the whole duration. The failure's text is the reason why no request
/// could be sent.
Result<std::vector<DatagramAnswer>, Failure> ask_networks(const DatagramInquiry& inquiry);

}  // namespace yuragi::drivers::bus
