#pragma once

#include <array>
#include <vector>

#include "daemon/tools/report/report_numbers.hpp"

namespace yuragi::daemon::tools::report {

/// The history of a sensor's states in bounded memory: totals, and the longest events of each.
/// Thread-safe: no.
class StateHistory {
 public:
  /// Adds a stretch in one state. Stretches come in order; adjoining ones of the same state are merged.
  void add(RecordedState state, double from_s, double to_s);

  std::array<StateTotal, kRecordedStates> totals();
  std::vector<StateEvent> events();

 private:
  void close();

  std::array<StateTotal, kRecordedStates> totals_{};
  std::array<std::vector<StateEvent>, kRecordedStates> longest_;
  StateEvent open_{RecordedState::kLive, 0.0, 0.0};
};

}  // namespace yuragi::daemon::tools::report
