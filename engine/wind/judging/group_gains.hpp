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
  /// The memory; also the first time constant, while little is known.
  double memory_s = 4.0 * 3600.0;
  double first_s = 900.0;
  /// In less wind nothing is learnt: the thresholds of cup anemometers would be mistaken for gains.
  double least_m_s = 2.0;
  /// Limit of a sensor's factor relative to the group's wind, or of its inverse.
  double most_factor = 1.5;
};

/// Learns each sensor's factor relative to the group's wind, and levels the sensors to their common mean (W41).
///
/// The group's wind is the geometric mean of the sensors after levelling, so that it does not change when one goes or
/// comes back. What is learnt leaves the geometric mean of all gains at 1. Causal, slow, without steps. Thread-safe:
/// no. Realtime-safe after construction: yes, but for restore().
class GroupGains {
 public:
  /// A sensor at a moment. Its mean is of its readings before levelling.
  struct Member {
    bool is_in = false;  ///< it measures the present wind, has no fault, and does not contradict the others
    double mean_m_s = 0.0;
  };
  struct Learnt {
    double deviation = 0.0;  ///< ln of how many times the group's wind it reads
    double learnt_s = 0.0;   ///< duration of the learning
  };

  explicit GroupGains(std::size_t sensor_count, const GroupGainsSettings& settings = {});

  /// Learns about once a second from two members or more. `members`: one for each sensor.
  void advance(MonoTime now, std::span<const Member> members) noexcept;

  /// The factor on a sensor's speeds; exactly 1 if nothing was learnt.
  double gain(std::size_t sensor) const noexcept { return gains_[sensor]; }
  /// Its reading relative to the group's wind; exactly 1 if nothing was learnt.
  double reads_times_group(std::size_t sensor) const noexcept;
  /// Returns true if the learnt factor is at the limit of levelling. The sensor can differ even more.
  bool is_at_bound(std::size_t sensor) const noexcept;

  std::span<const Learnt> learnt() const noexcept { return learnt_; }

  /// Call when a sensor's readings have changed: the group learns again, as fast as at first, from the present state,
  /// without a jump.
  void relearn(std::size_t sensor) noexcept { learnt_[sensor].learnt_s = 0.0; }

  /// Continues from an earlier run's result: one for each sensor; all 0: nothing is known of it. The mean of the known
  /// ones is set to 0, because a sensor can have been removed. Returns false, and changes nothing, if a value is not
  /// finite, or a deviation is out of bounds, before or after that.
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

/// Returns true if anything is known of a sensor.
constexpr bool is_known(const GroupGains::Learnt& learnt) noexcept {
  return learnt.learnt_s > 0.0 || learnt.deviation != 0.0;
}

/// The learnt factors of sensors, by name.
using LearntByName = std::map<std::string, GroupGains::Learnt>;

}  // namespace yuragi::wind::judging
