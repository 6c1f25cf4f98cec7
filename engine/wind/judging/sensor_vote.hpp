#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/time.hpp"

namespace yuragi::wind::judging {

/// The result of comparing one sensor with the others.
enum class Vote : std::uint8_t {
  kNone,      ///< no contradiction, or no other sensor to compare with
  kDisputed,  ///< they differ, without a majority
  kOutvoted,  ///< a majority agrees, and this one does not
};

struct VoteSettings {
  /// The compared mean speeds are over this time.
  double memory_s = 300.0;
  /// Two means agree unless one is above this factor times the other plus this difference: sensors are at different
  /// places, and a courtyard has half the wind of a roof.
  double factor = 3.0;
  double offset_m_s = 3.0;
  /// The time for which a sensor must differ before it is outvoted, and agree before it is accepted again.
  double patience_s = 600.0;
};

/// Compares the sensors of an installation by their slow mean speeds.
///
/// Three or more can vote: if more than half of them agree with the median of all, one that does not agree with it for
/// `patience_s` is outvoted; it must agree for as long to be accepted again, and while there is no such majority its
/// state is kept. Without a majority (two sensors, or all differ) those that differ are disputed, and all are still
/// used. A sensor takes part once it has sent readings for `memory_s` without a longer gap. Thread-safe: no.
/// Realtime-safe after construction: yes.
class SensorVote {
 public:
  explicit SensorVote(std::size_t sensor_count, const VoteSettings& settings = {});

  /// Takes a reading of a sensor, at its own time, calibrated. One that is earlier than the last changes nothing.
  void accept(std::size_t sensor, MonoTime time, double speed_m_s) noexcept;

  /// Whether a sensor can be compared at the moment: it is live, not a recording, and not frozen.
  void set_comparable(std::size_t sensor, bool takes_part) noexcept { voters_[sensor].is_comparable = takes_part; }

  /// Forgets the mean speed of a sensor whose readings have changed: it takes part again after `memory_s`. The decision
  /// about it is kept until then.
  void forget_mean(std::size_t sensor) noexcept;

  /// Advances to `now`. Counts votes about once a second.
  void advance(MonoTime now) noexcept;

  Vote vote_on(std::size_t sensor) const noexcept;

  /// Returns true if it is being compared, and agrees with the majority, or, without one, with all. Unlike vote_on()
  /// without patience.
  bool agrees(std::size_t sensor) const noexcept { return voters_[sensor].agrees; }

  /// Its mean speed, and the median of the others that can be compared; nullopt if there is none.
  double mean_m_s(std::size_t sensor) const noexcept { return voters_[sensor].mean_m_s; }
  std::optional<double> others_m_s(std::size_t sensor) const noexcept { return voters_[sensor].others_m_s; }

 private:
  struct Voter {
    bool is_comparable = false;
    std::optional<MonoTime> last;
    double measured_s = 0.0;
    double mean_m_s = 0.0;
    std::optional<double> others_m_s;
    double outvoted_s = 0.0;  ///< time of contradiction, minus time of agreement
    double disputed_s = 0.0;
    bool is_outvoted = false;
    bool agrees = false;
    bool is_disputed = false;
  };

  bool can_be_compared(const Voter& voter) const noexcept;
  bool agree(double a_m_s, double b_m_s) const noexcept;
  std::optional<double> majority_m_s() noexcept;
  double median_without(const Voter* left_out) noexcept;

  VoteSettings settings_;
  std::vector<Voter> voters_;
  std::vector<double> means_m_s_;  ///< room for a median
  std::optional<MonoTime> counted_;
};

}  // namespace yuragi::wind::judging
