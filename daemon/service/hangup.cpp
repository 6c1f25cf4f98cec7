#include "daemon/service/hangup.hpp"

#include <csignal>

#include <poll.h>
#include <unistd.h>

#include "daemon/service/hold_back_hangups.hpp"

namespace yuragi::daemon::service {
namespace {

void set_hangups_blocked(bool is_blocked) {
  sigset_t hangup;
  sigemptyset(&hangup);
  sigaddset(&hangup, SIGHUP);
  pthread_sigmask(is_blocked ? SIG_BLOCK : SIG_UNBLOCK, &hangup, nullptr);
}

}  // namespace

void hold_back_hangups() {
  set_hangups_blocked(true);
}

Hangups::Hangups(boost::asio::io_context& io) : signals(io, SIGHUP) {
  set_hangups_blocked(false);
}

Terminal::Terminal() : was_there_(isatty(STDIN_FILENO) == 1) {}

bool Terminal::is_closed() const {
  pollfd input{.fd = STDIN_FILENO, .events = 0, .revents = 0};
  return was_there_ && poll(&input, 1, 0) == 1 && (input.revents & POLLHUP) != 0;
}

}  // namespace yuragi::daemon::service
