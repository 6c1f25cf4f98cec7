#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "daemon/settings/sensor_config.hpp"
#include "engine/wind/blend/source_record.hpp"
#include "engine/wind/judging/group_gains.hpp"
#include "engine/wind/judging/reading_judge.hpp"
#include "engine/wind/judging/sensor_vote.hpp"

namespace yuragi::daemon::sensing {

/// How the readings of one sensor are judged.
struct JuryRules {
  std::optional<wind::judging::JudgeSettings> judge{};  ///< empty: all are believed
  bool is_compared = false;                             ///< with the other sensors
  double unchanged_for_s = 0.0;                         ///< as blend::SourceSettings has it
};

/// The rules of a configured sensor, or of a recording that is processed as its readings. One whose scale is unknown is
/// not compared.
JuryRules jury_rules_of(const settings::SensorConfig& sensor);

/// Which readings of an installation's sensors are believed: each sensor is judged by itself (ReadingJudge) and
/// compared with the others (SensorVote). Those that are compared are levelled to their common mean, too (GroupGains).
/// The daemon's live wind and the offline tools ask the same jury.
/// Thread-safe: no. Realtime-safe after construction: yes.
class SensorJury {
 public:
  enum class Verdict : std::uint8_t {
    kDropped,   ///< it is impossible, or late: it counts nowhere
    kDoubted,   ///< it is left out of the wind
    kBelieved,  ///< it goes to the estimator
  };

  /// `stale_intervals`: as blend::Settings has it. `is_levelling`: false: no sensor is levelled.
  SensorJury(const std::vector<JuryRules>& sensors, double stale_intervals, bool is_levelling);

  /// Judges the next reading of a sensor, calibrated, and not of the future.
  Verdict hear(std::size_t sensor, const wind::Reading& reading) noexcept;

  /// The reading that hear() has just taken, levelled, for the estimator. The same bits if nothing was learnt. A
  /// repeated reading is levelled as it was the first time.
  wind::Reading levelled(std::size_t sensor, wind::Reading reading) const noexcept;

  /// Readings that were refused before they came here as impossible.
  void count_impossible(std::size_t sensor, std::uint64_t readings) noexcept;

  /// Compares the sensors that measure the present wind, and have no fault, and learns how they differ.
  void compare(MonoTime now) noexcept;

  /// Judges a sensor by other rules from now on; its `unchanged_for_s` stays. What is known of it stays, too.
  void change(std::size_t sensor, const JuryRules& rules);

  /// Call when a sensor's calibration has changed. `last`: its last reading by the old one, and by the new one;
  /// nullopt: it has sent none. Its difference from the others is learnt again.
  void recalibrate(std::size_t sensor, const std::optional<std::pair<wind::Reading, wind::Reading>>& last) noexcept;

  const wind::judging::ReadingJudge& judge(std::size_t sensor) const noexcept { return members_[sensor].judge; }
  const wind::judging::SensorVote& vote() const noexcept { return vote_; }
  const wind::judging::GroupGains& gains() const noexcept { return gains_; }
  /// Continues from what was learnt before, one for each sensor (GroupGains::restore()). Values of sensors that are not
  /// compared any more are ignored; if nothing is levelled, all are.
  bool restore_gains(std::span<const wind::judging::GroupGains::Learnt> learnt);
  /// How many times the group's wind it reads; 1: it is not levelled.
  double reads_times_group(std::size_t sensor) const noexcept;
  /// Returns true if its gain is at the bound: it may differ more, but is not levelled further.
  bool is_levelled_at_most(std::size_t sensor) const noexcept {
    return is_levelled(sensor) && gains_.is_at_bound(sensor);
  }

  wind::SourceReport report(std::size_t sensor, MonoTime now) const noexcept {
    return members_[sensor].record.report(now, stale_intervals_);
  }

 private:
  bool is_levelled(std::size_t sensor) const noexcept { return is_levelling_ && members_[sensor].rules.is_compared; }

  struct Member {
    JuryRules rules;
    wind::judging::ReadingJudge judge;
    wind::blend::SourceRecord record;  ///< believed or not
    bool is_last_believed = false;     ///< of the last reading that was judged
    double gain = 1.0;                 ///< of the last reading that was no repetition
  };

  double stale_intervals_;
  std::vector<Member> members_;
  wind::judging::SensorVote vote_;
  bool is_levelling_;
  wind::judging::GroupGains gains_;
  std::vector<wind::judging::GroupGains::Member> group_;  ///< room for the arguments of gains_
};

}  // namespace yuragi::daemon::sensing
