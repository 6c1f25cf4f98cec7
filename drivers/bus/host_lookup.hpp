#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/ip/tcp.hpp>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi {

/// The addresses of a host name. The system's own look-up cannot be ended, and may wait for a name server for a
/// long time: here it has a thread to itself, which is abandoned where it takes too long.
///
/// Thread-safe: interrupt() alone; everything else belongs to one thread.
class HostLookup {
 public:
  HostLookup(std::string host, std::uint16_t port);

  /// The addresses, best first, at least one. After a failure it can be called again: a look-up that is still under
  /// way is waited for, not begun anew.
  Result<std::vector<boost::asio::ip::tcp::endpoint>, Failure> find(Nanoseconds timeout);

  /// Has a look-up been begun that has not ended? After find() failed: it took too long, and can be waited for again.
  bool is_under_way() const;

  /// Ends a find() that waits, and all later ones.
  void interrupt() noexcept;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace yuragi
