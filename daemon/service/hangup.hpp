#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>

namespace yuragi::daemon::service {

/// Takes SIGHUP from now on, also one that was held back; what comes before somebody waits for it is kept. To be made
/// before any thread and any child, which inherit what is held back.
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
