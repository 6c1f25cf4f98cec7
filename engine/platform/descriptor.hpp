#pragma once

#include <utility>

#include <unistd.h>

namespace yuragi::platform {

/// Closes a descriptor, unless it is negative, and sets it to -1.
inline void close_if_open(int& descriptor) noexcept {
  if (descriptor >= 0) ::close(std::exchange(descriptor, -1));
}

/// A descriptor that is closed with this object; negative: none.
class Descriptor {
 public:
  explicit Descriptor(int value) noexcept : value_(value) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const noexcept { return value_; }
  void reset() noexcept { close_if_open(value_); }
  /// Returns the descriptor, which the caller closes.
  int release() noexcept { return std::exchange(value_, -1); }

 private:
  int value_;
};

}  // namespace yuragi::platform
