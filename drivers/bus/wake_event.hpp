#pragma once

#include <cerrno>
#include <system_error>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace yuragi {

/// An eventfd: something to wait for beside a device, so that a wait can be ended from elsewhere. Once set it stays
/// set.
///
/// Thread-safe: yes. Throws std::system_error where the process has no descriptors left.
class WakeEvent {
 public:
  WakeEvent() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  }
  ~WakeEvent() { ::close(descriptor_); }
  WakeEvent(const WakeEvent&) = delete;
  WakeEvent& operator=(const WakeEvent&) = delete;

  /// Can be read from when it is set.
  int descriptor() const noexcept { return descriptor_; }
  void set() noexcept { eventfd_write(descriptor_, 1); }
  bool is_set() const noexcept {
    pollfd wait{descriptor_, POLLIN, 0};
    return poll(&wait, 1, 0) == 1;
  }

 private:
  int descriptor_;
};

}  // namespace yuragi
