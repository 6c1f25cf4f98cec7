#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>

namespace yuragi::daemon::service {

/// Takes SIGHUP from now on, also one that was held back; a signal that arrives before anybody waits for it is kept.
/// Make it before any thread and any child, which inherit blocked signals.
struct Hangups {
  explicit Hangups(boost::asio::io_context& io);
  boost::asio::signal_set signals;
};

/// The terminal that standard input was when this was made.
class Terminal {
 public:
  Terminal();

  /// Returns true if there was one and it has been closed.
  bool is_closed() const;

 private:
  bool was_there_;
};

}  // namespace yuragi::daemon::service
