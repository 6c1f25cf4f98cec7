#pragma once

#include <cstdint>

#include "simulators/usb/umockdev_calls.hpp"

namespace yuragi::simulators::usb {

/// A device node, served as the kernel would: a program's system calls become transfers. Thread-safe: no.
class EmulatedNode {
 public:
  virtual ~EmulatedNode() = default;

  /// Readable while calls wait.
  int descriptor() const noexcept { return calls_.descriptor(); }
  const ProgramCallQueue& calls() const noexcept { return calls_; }
  bool is_open() const noexcept { return calls_.opens() > 0; }

  /// Serves the calls that wait, `time_s` after the start.
  virtual void serve(double time_s) = 0;

  /// The device has been unplugged: from now on calls fail as they do in the kernel. Its host is not used again.
  virtual void unplug() = 0;

 protected:
  ProgramCallQueue calls_;
};

}  // namespace yuragi::simulators::usb
