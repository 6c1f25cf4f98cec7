#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/time.hpp"

namespace yuragi::wind::judging {

struct GroupGainsSettings {
  /// What was learnt counts for as long; the first time constant while little is known.
  double memory_s = 4.0 * 3600.0;
  double first_s = 900.0;
  /// In less wind nothing is learnt: the thresholds of cup anemometers would be taken for gains.
  double least_m_s = 2.0;
  /// A sensor counts as reading at most so many times the group's wind, or its inverse.
  double most_factor = 1.5;
};

/// Learns how many times the group's wind each sensor reads, and levels the sensors to their common mean (W41).
///
/// The group's wind is the geometric mean of the sensors after levelling, so that it does not change when one goes or
/// comes back. What is learnt leaves the geometric mean of all gains at 1. Causal; slow: no step.
/// Thread-safe: no. Realtime-safe after construction: yes, but for restore().
class GroupGains {
 public:
  /// A sensor at a moment. Its mean is of its readings before levelling.
  struct Member {
    bool is_in = false;  ///< it measures the present wind, has no fault, and does not contradict the others
    double mean_m_s = 0.0;
  };
  struct Learnt {
    double deviation = 0.0;  ///< ln of how many times the group's wind it reads
    double learnt_s = 0.0;   ///< for how long it was learnt
  };

  explicit GroupGains(std::size_t sensor_count, const GroupGainsSettings& settings = {});

  /// Learns about once a second from two members or more. `members`: one for each sensor.
  void advance(MonoTime now, std::span<const Member> members) noexcept;

  /// What a sensor's speeds are multiplied by; exactly 1 if nothing was learnt.
  double gain(std::size_t sensor) const noexcept { return gains_[sensor]; }
  /// How many times the group's wind it reads; exactly 1 if nothing was learnt.
  double reads_times_group(std::size_t sensor) const noexcept;
  /// Is what was learnt the most that is levelled? It may read even more, or less.
  bool is_at_bound(std::size_t sensor) const noexcept;

  std::span<const Learnt> learnt() const noexcept { return learnt_; }

  /// A sensor reads otherwise from now on: the group learns anew, as fast as at first, from what it has, without a
  /// jump.
  void relearn(std::size_t sensor) noexcept { learnt_[sensor].learnt_s = 0.0; }

  /// Goes on from what an earlier run learnt: one for each sensor; all 0: nothing is known of it. The mean of the known
  /// is made 0: a sensor may have gone for good. False, and nothing changes, if a value is not finite, or a
  /// deviation is out of bounds, before or after that.
  bool restore(std::span<const Learnt> learnt);

 private:
  double most() const noexcept;
  void learn(std::span<const Member> members, double step_s) noexcept;
  void renew_gains() noexcept;

  GroupGainsSettings settings_;
  std::vector<Learnt> learnt_;
  std::vector<double> gains_;
  std::optional<MonoTime> learnt_at_;
};

/// Is anything known of a sensor?
constexpr bool is_known(const GroupGains::Learnt& learnt) noexcept {
  return learnt.learnt_s > 0.0 || learnt.deviation != 0.0;
}

/// What was learnt of sensors, by their names.
using LearntByName = std::map<std::string, GroupGains::Learnt>;

}  // namespace yuragi::wind::judging
