#include "daemon/tools/report/state_history.hpp"

#include <algorithm>

namespace yuragi::daemon::tools::report {
namespace {

bool is_longer(const StateEvent& a, const StateEvent& b) {
  return a.length_s() > b.length_s();
}

void keep_longest(std::vector<StateEvent>& events) {
  if (events.size() <= SensorNumbers::kMaxEvents) return;
  const auto end = events.begin() + static_cast<std::ptrdiff_t>(SensorNumbers::kMaxEvents);
  std::nth_element(events.begin(), end, events.end(), is_longer);
  events.erase(end, events.end());
}

}  // namespace

void StateHistory::add(RecordedState state, double from_s, double to_s) {
  if (!(to_s > from_s)) return;
  if (state == open_.state && from_s == open_.to_s) {
    open_.to_s = to_s;
    return;
  }
  close();
  open_ = {state, from_s, to_s};
}

void StateHistory::close() {
  if (!(open_.length_s() > 0.0)) return;
  const auto index = static_cast<std::size_t>(open_.state);
  StateTotal& total = totals_[index];
  ++total.count;
  total.time_s += open_.length_s();
  total.longest_s = std::max(total.longest_s, open_.length_s());
  if (open_.state != RecordedState::kLive) {
    longest_[index].push_back(open_);
    if (longest_[index].size() > 2 * SensorNumbers::kMaxEvents) keep_longest(longest_[index]);
  }
  open_ = {open_.state, open_.to_s, open_.to_s};
}

std::array<StateTotal, kRecordedStates> StateHistory::totals() {
  close();
  return totals_;
}

std::vector<StateEvent> StateHistory::events() {
  close();
  std::vector<StateEvent> all;
  for (std::vector<StateEvent>& events : longest_) {
    keep_longest(events);
    all.insert(all.end(), events.begin(), events.end());
  }
  std::ranges::sort(all, {}, &StateEvent::from_s);
  return all;
}

}  // namespace yuragi::daemon::tools::report
