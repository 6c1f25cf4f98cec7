#include "engine/wind/blend/source_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace yuragi::wind::blend {
namespace {

/// A critically damped step has covered 91 % after 4 time constants (engine/METHOD.md M18).
constexpr double kRateTimesHandover = 4.0;
constexpr double kForgivenAfter_s = 600.0;

}  // namespace

SourceChoice::SourceChoice(std::span<const SourceSettings> sources, double handover_s, double return_after_s)
    : handover_s_(handover_s), return_after_s_(return_after_s) {
  for (const SourceSettings& settings : sources) {
    const int place = static_cast<int>(entries_.size()) + 1;
    Entry entry;
    entry.is_relative = settings.is_relative;
    entry.priority = settings.priority != 0 ? settings.priority : place;
    entry.share = settings.weight;
    entries_.push_back(entry);
  }
}

void SourceChoice::note_failures(Entry& entry, double dt_s) const noexcept {
  if (!entry.is_live) {
    if (entry.was_live) entry.failures = std::min(entry.failures + 1, kMaxFailures);
    entry.live_for_s = 0.0;
    entry.is_ready = false;
  } else {
    if (entry.was_live) entry.live_for_s += dt_s;
    const double wait_s = entry.failures == 0 ? 0.0 : std::ldexp(return_after_s_, entry.failures - 1);
    if (entry.live_for_s >= wait_s) entry.is_ready = true;
    if (entry.live_for_s >= std::max(wait_s, kForgivenAfter_s)) entry.failures = 0;
  }
  entry.was_live = entry.is_live;
}

/// Distributes `wanted` among those of the lowest priority that can take it. If none can, it changes nothing and
/// returns false.
template <class MayTake>
bool SourceChoice::give(double Entry::*wanted, bool relative, MayTake may_take) noexcept {
  int lowest = std::numeric_limits<int>::max();
  double sum = 0.0;
  for (const Entry& entry : entries_) {
    if (entry.is_relative != relative || !may_take(entry) || entry.priority > lowest) continue;
    if (entry.priority < lowest) sum = 0.0;
    lowest = entry.priority;
    sum += entry.share;
  }
  if (!(sum > 0.0)) return false;
  for (Entry& entry : entries_) {
    const bool takes = entry.is_relative == relative && may_take(entry) && entry.priority == lowest;
    entry.*wanted = takes ? entry.share / sum : 0.0;
  }
  return true;
}

void SourceChoice::step(double dt_s) noexcept {
  for (Entry& entry : entries_) note_failures(entry, dt_s);
  const auto is_ready = [](const Entry& entry) { return entry.is_ready; };
  const auto is_live = [](const Entry& entry) { return entry.is_live; };

  // The weights; a source that is selected already need not wait. Then those of the gusts.
  const bool given = give(&Entry::weight_wanted, false, is_ready) ||
                     give(&Entry::weight_wanted, true, is_ready) > 0.0 || give(&Entry::weight_wanted, false, is_live) ||
                     give(&Entry::weight_wanted, true, is_live);
  bool relative_has_weight = false;
  for (Entry& entry : entries_) {
    if (entry.weight_wanted > 0.0 && entry.is_live) entry.is_ready = true;
    relative_has_weight = relative_has_weight || (entry.is_relative && entry.weight_wanted > 0.0);
  }
  if (relative_has_weight) {
    for (Entry& entry : entries_) entry.gusts_wanted = 0.0;
  } else if (given) {
    if (!give(&Entry::gusts_wanted, true, is_ready)) give(&Entry::gusts_wanted, true, is_live);
  }

  // The first step has nothing to fade from.
  const bool is_first = !std::exchange(has_begun_, true);
  for (Entry& entry : entries_) {
    if (is_first) {
      entry.weight.value = entry.weight_wanted;
      entry.gusts.value = entry.gusts_wanted;
    }
    entry.weight.step(entry.weight_wanted, kRateTimesHandover / handover_s_, dt_s);
    entry.gusts.step(entry.gusts_wanted, kRateTimesHandover / handover_s_, dt_s);
    entry.is_chosen = entry.weight_wanted > 0.0 || entry.gusts_wanted > 0.0;
  }
}

}  // namespace yuragi::wind::blend
