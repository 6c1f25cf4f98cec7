#pragma once

#include <utility>

#include <unistd.h>

namespace yuragi {

/// Owns a file descriptor.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Descriptor() {
    if (value_ >= 0) close(value_);
  }

  int get() const { return value_; }
  void reset() { Descriptor gone(std::exchange(value_, -1)); }

 private:
  int value_ = -1;
};

}  // namespace yuragi
