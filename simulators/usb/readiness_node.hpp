#pragma once

#include <cstdint>
#include <string>

namespace yuragi::simulators::usb {

/// A FIFO in the place of a device node of umockdev's, whose readiness can be set. umockdev's own node is an ordinary
/// file, which is always ready, so that poll() would never wait. Reads and writes are intercepted elsewhere
/// (ProgramCallQueue); only poll() sees this file. Thread-safe: no.
class ReadinessNode {
 public:
  /// The direction whose readiness is set; the other one is always ready, or never polled.
  enum class Direction : std::uint8_t { kReadable, kWritable };

  /// Makes it at `path` (an absolute path inside the testbed), replacing the file that is there. Throws
  /// std::system_error.
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

}  // namespace yuragi::simulators::usb
