#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/math/critically_damped.hpp"
#include "engine/wind/blend/blend_settings.hpp"

namespace yuragi {

/// Which of several sources has the word, and how much of it: by role, priority and weight, with hysteresis, slewed.
///
/// The live absolute sources of the lowest priority number share the word by their weights; where there are none, the
/// relative ones do; where nobody is live, those who had it keep it. A source that has failed is chosen again only when
/// it has been live for `return_after_s`, and for twice as long after each further failure (up to 64 times; ten minutes
/// without one and all is forgiven), so that a flapping one does not make the wind flap; unless there is nobody else.
/// While absolute sources have the word, the live relative ones of the lowest number have the gusts. All weights move
/// by critically damped filters; only what the first step finds is taken at once. Allocates at construction only.
/// Thread-safe: no. Realtime-safe: yes.
class SourceChoice {
 public:
  /// A source for each of the settings.
  SourceChoice(std::span<const BlendSourceSettings> sources, double handover_s, double return_after_s);

  /// Time goes on by dt_s; tell with set_live() before who is live.
  void set_live(std::size_t source, bool is_live) noexcept { entries_[source].is_live = is_live; }
  void step(double dt_s) noexcept;

  /// Has it the word, or a part of the gusts, or is it on the way there?
  bool is_chosen(std::size_t source) const noexcept { return entries_[source].is_chosen; }
  /// The part of the word that it has, 0 to 1: the mean and all that it knows of the gusts.
  double word(std::size_t source) const noexcept { return std::clamp(entries_[source].word.value, 0.0, 1.0); }
  /// The part of the gusts that it has, 0 to 1, where those who have the word know nothing.
  double gusts(std::size_t source) const noexcept { return std::clamp(entries_[source].gusts.value, 0.0, 1.0); }

 private:
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
    double word_wanted = 0.0, gusts_wanted = 0.0;
    CriticallyDamped word, gusts;
  };

  template <class MayTake>
  bool give(double Entry::*wanted, bool relative, MayTake may_take) noexcept;
  void note_failures(Entry& entry, double dt_s) const noexcept;

  double handover_s_;
  double return_after_s_;
  bool has_begun_ = false;
  std::vector<Entry> entries_;
};

}  // namespace yuragi
