#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi::daemon::feeds {

/// Where a feed's datagrams go: a host that is looked up without waiting, a broadcast or a multicast address (with a
/// time to live of 1). Never waits; a datagram that cannot be sent is dropped. What goes wrong is logged once, and
/// again when it is over. Thread-safe: no.
class DatagramTarget {
 public:
  /// `feed`: the feed's name, stands before what is logged. `address`: HOST:PORT, which was checked. `interface`: this
  /// machine's IPv4 address on the network for a multicast address; empty: the system chooses.
  DatagramTarget(std::string feed, const std::string& address, std::string interface = {});
  ~DatagramTarget();

  void send(std::span<const std::uint8_t> datagram, MonoTime now);

  const std::string& address() const noexcept { return address_; }
  std::uint64_t messages() const noexcept { return messages_; }
  std::uint64_t bytes() const noexcept { return bytes_; }
  std::optional<MonoTime> last_sent() const noexcept { return last_sent_; }
  /// Why nothing can be sent at present, and what to do; empty: it can.
  const std::string& trouble() const noexcept { return trouble_; }

 private:
  struct Socket;
  void open(MonoTime now);
  void note(const std::string& trouble, MonoTime now);

  std::string feed_, address_, interface_;
  std::unique_ptr<Socket> socket_;
  std::uint64_t messages_ = 0, bytes_ = 0;
  std::optional<MonoTime> last_sent_, opened_, failed_;
  std::string trouble_;
};

}  // namespace yuragi::daemon::feeds
