#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/state_pass.hpp"
#include "engine/math/critically_damped.hpp"
#include "engine/wind/blend/blend_settings.hpp"

namespace yuragi::wind::blend {

/// Selects among several sources and weights them: by role, priority and weight, with hysteresis, slewed.
///
/// The live absolute sources of the lowest priority number share the total weight of 1 by their settings; if there are
/// none, the relative ones do; where no source is live, the weights stay. A source that has failed is chosen again only
/// when it has been live for `return_after_s`, and for twice as long after each further failure (up to 64 times; ten
/// minutes without one reset that), so that an unreliable one does not change the wind repeatedly; but at once if there
/// is no other source. While absolute sources are selected, the live relative ones of the lowest number supply the
/// gusts. All weights are slewed by critically damped filters; only the first step sets them at once. Allocates at
/// construction only. Thread-safe: no. Realtime-safe: yes.
class SourceChoice {
 public:
  /// A source for each of the settings.
  SourceChoice(std::span<const SourceSettings> sources, double handover_s, double return_after_s);

  /// Advances by dt_s; set_live() has been called for each source before.
  void set_live(std::size_t source, bool is_live) noexcept { entries_[source].is_live = is_live; }
  void step(double dt_s) noexcept;

  /// Returns true if it is selected, for the mean or for gusts, or being faded in.
  bool is_chosen(std::size_t source) const noexcept { return entries_[source].is_chosen; }
  /// Its weight, 0 to 1, in the mean and in the gusts that it resolves.
  double weight(std::size_t source) const noexcept { return std::clamp(entries_[source].weight.value, 0.0, 1.0); }
  /// Its weight, 0 to 1, in the gusts that the selected absolute sources do not resolve.
  double gusts(std::size_t source) const noexcept { return std::clamp(entries_[source].gusts.value, 0.0, 1.0); }

  void list_state(StatePass& pass) {
    pass(has_begun_);
    pass.grown(std::span(entries_));
  }

 private:
  static constexpr int kMaxFailures = 7;  ///< counted

  struct Entry {
    bool is_relative = false;
    int priority = 0;
    double share = 1.0;  ///< by its settings
    bool is_live = false;
    bool was_live = false;
    bool is_ready = false;  ///< live for long enough
    bool is_chosen = false;
    double live_for_s = 0.0;
    int failures = 0;
    double weight_wanted = 0.0, gusts_wanted = 0.0;
    math::CriticallyDamped weight, gusts;

    /// All but what its settings are.
    void list_state(StatePass& pass) {
      pass(is_live, was_live, is_ready, is_chosen, weight_wanted, gusts_wanted, weight, gusts);
      pass.total(live_for_s);
      auto failed = static_cast<std::size_t>(failures);
      pass.index(failed, kMaxFailures + 1);
      failures = static_cast<int>(failed);
    }
  };

  template <class MayTake>
  bool give(double Entry::*wanted, bool relative, MayTake may_take) noexcept;
  void note_failures(Entry& entry, double dt_s) const noexcept;

  double handover_s_;
  double return_after_s_;
  bool has_begun_ = false;
  std::vector<Entry> entries_;
};

}  // namespace yuragi::wind::blend
