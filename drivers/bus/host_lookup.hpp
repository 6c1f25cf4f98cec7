#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/ip/tcp.hpp>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// Looks up the addresses of a host name. The system's own look-up cannot be interrupted, and may wait for a name
/// server for a long time: here it runs on a thread of its own, which is abandoned when it takes too long.
///
/// Thread-safe: interrupt() alone; everything else belongs to one thread.
class HostLookup {
 public:
  HostLookup(std::string host, std::uint16_t port);

  /// The addresses, best first, at least one. After a failure it can be called again: a look-up that is still in
  /// progress is continued.
  Result<std::vector<boost::asio::ip::tcp::endpoint>, Failure> find(Nanoseconds timeout);

  /// Returns true if a look-up is in progress. After a failed find(): it took too long, and find() can wait for it
  /// again.
  bool is_under_way() const;

  /// Ends a waiting find(), and all later ones.
  void interrupt() noexcept;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace yuragi::drivers::bus
