#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulators/faults.hpp"

namespace yuragi::sim {

/// A simulated sensor: it says what it waits for, and works when that is there. It never reads a clock.
class Simulator {
 public:
  virtual ~Simulator() = default;

  /// What it can suffer; a constant.
  virtual std::span<const FaultKind> known_faults() const = 0;

  /// The descriptors that bring it work.
  virtual std::vector<int> descriptors() const = 0;

  /// Does what there is to do `time_s` after the start: `ready` are those of its descriptors that can be read, `fault`
  /// is what goes wrong at the moment, one of its known ones. Called at least 20 times a second.
  virtual void serve(std::span<const int> ready, double time_s, std::optional<FaultKind> fault) = 0;

  /// One line for people.
  virtual std::string status() const = 0;

  /// True: there is nothing left to do, and run() returns.
  virtual bool is_over() const { return false; }
};

struct RunOptions {
  std::optional<double> duration_s;  ///< nothing: until a signal
  bool verbose = false;              ///< a status line a second, terminal or not
};

/// Runs a simulator in real time until it is over, the duration is over, or SIGINT or SIGTERM
/// comes. Faults come by `faults` and, as
/// lines, by standard input; its end changes nothing. The status goes to standard error.
void run(Simulator& simulator, Faults faults, const RunOptions& options);

}  // namespace yuragi::sim
