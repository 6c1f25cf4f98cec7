#pragma once

#include <cstdint>
#include <string>

namespace yuragi::sim {

/// A FIFO in the place of a device node of umockdev's, whose readiness is what we say. An ordinary file, as umockdev
/// has it, is always ready: whoever waits for it with poll() never waits. What is read and written goes by other ways;
/// only poll() sees this. Thread-safe: no.
class ReadinessNode {
 public:
  /// What we can say of it; in the other direction it is always ready, or never of interest.
  enum class Direction : std::uint8_t { kReadable, kWritable };

  /// Makes it at `path` (an absolute path inside the testbed), in the place of what is there. Throws std::system_error.
  ReadinessNode(const std::string& path, Direction direction);
  ~ReadinessNode();
  ReadinessNode(const ReadinessNode&) = delete;
  ReadinessNode& operator=(const ReadinessNode&) = delete;

  void set_ready(bool is_ready) noexcept;

 private:
  Direction direction_;
  int descriptor_ = -1;
  bool is_filled_ = false;
};

}  // namespace yuragi::sim
