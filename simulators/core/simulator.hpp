#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulators/core/faults.hpp"

namespace yuragi::simulators::core {

/// A simulated sensor. It names the descriptors that it waits for, and is served when one of them can be read, or at a
/// regular pace. It never reads a clock. Thread-safe: no.
class Simulator {
 public:
  virtual ~Simulator() = default;

  /// The faults that it can play; a constant.
  virtual std::span<const FaultKind> known_faults() const = 0;

  /// The descriptors on which its clients' bytes and connections arrive.
  virtual std::vector<int> descriptors() const = 0;

  /// Advances to `time_s` after the start: `ready` are those of its descriptors that can be read, `fault` is the fault
  /// of this moment, one of known_faults(). Called at least 20 times a second.
  virtual void serve(std::span<const int> ready, double time_s, std::optional<FaultKind> fault) = 0;

  /// A line that was typed. True: it was for the simulator; otherwise it is a command for Faults::obey().
  virtual bool take_line(const std::string& /*line*/) { return false; }

  /// One line for people.
  virtual std::string status() const = 0;

  /// Returns true once it has ended: run() then returns.
  virtual bool is_over() const { return false; }
};

struct RunOptions {
  std::optional<double> duration_s;  ///< nothing: until a signal
  bool verbose = false;              ///< a status line a second, terminal or not
};

/// Runs a simulator in real time until it is over, the duration has passed, or SIGINT or SIGTERM arrives. Faults are
/// those of `faults` and those that are typed as lines on standard input, which may end at any time. The status goes to
/// standard error. Throws std::system_error if waiting itself fails.
void run(Simulator& simulator, Faults faults, const RunOptions& options);

}  // namespace yuragi::simulators::core
