#pragma once

#include <cstdint>

#include "simulators/usb/umockdev_calls.hpp"

namespace yuragi::sim {

/// A device node as the kernel would serve it: calls of programs are turned into transfers. Thread-safe: no.
class EmulatedNode {
 public:
  virtual ~EmulatedNode() = default;

  /// Readable while calls wait.
  int descriptor() const noexcept { return calls_.descriptor(); }
  const ProgramCallQueue& calls() const noexcept { return calls_; }
  bool is_open() const noexcept { return calls_.opens() > 0; }

  /// Does what programs ask of the node, `time_s` after the start.
  virtual void serve(double time_s) = 0;

  /// The device is gone: whatever is asked from now on fails as it does in the kernel then. Its host is not used again.
  virtual void unplug() = 0;

 protected:
  ProgramCallQueue calls_;
};

}  // namespace yuragi::sim
