#include "drivers/bus/interruption.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace yuragi::drivers::bus {

Interruption::Interruption() : event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (event_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

Interruption::~Interruption() {
  ::close(event_);
}

void Interruption::set() noexcept {
  eventfd_write(event_, 1);
}

bool Interruption::is_set() const noexcept {
  return wait(-1, WaitFor::kReadable, Nanoseconds::zero()) == WaitEnd::kInterrupted;
}

void Interruption::clear() noexcept {
  eventfd_t ignored = 0;
  eventfd_read(event_, &ignored);
}

WaitEnd Interruption::wait(int descriptor, WaitFor what, Nanoseconds timeout) const noexcept {
  const short events = what == WaitFor::kReadable ? POLLIN : POLLOUT;
  std::array<pollfd, 2> waits = {pollfd{event_, POLLIN, 0}, pollfd{descriptor, events, 0}};
  const Nanoseconds rest = std::max(timeout, Nanoseconds::zero());
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(rest);
  const timespec time = {whole.count(), (rest - whole).count()};

  // A signal ends the wait early, which counts as a time-out: callers wait again.
  if (ppoll(waits.data(), waits.size(), &time, nullptr) <= 0) return WaitEnd::kTimeout;
  return waits[0].revents != 0 ? WaitEnd::kInterrupted : WaitEnd::kReady;
}

}  // namespace yuragi::drivers::bus
