#pragma once

#include <array>
#include <vector>

#include "daemon/tools/report/report_numbers.hpp"

namespace yuragi {

/// Keeps the story of a sensor's states in memory that does not grow: totals, and the longest events of each.
/// Thread-safe: no.
class StateHistory {
 public:
  /// From one moment to the next it was in this state. Stretches come in order; equal ones that touch are one.
  void add(RecordedState state, double from_s, double to_s);

  std::array<StateTotal, kRecordedStates> totals();
  std::vector<StateEvent> events();

 private:
  void close();

  std::array<StateTotal, kRecordedStates> totals_{};
  std::array<std::vector<StateEvent>, kRecordedStates> longest_;
  StateEvent open_{RecordedState::kLive, 0.0, 0.0};
};

}  // namespace yuragi
