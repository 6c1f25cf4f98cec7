#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/wind/wind_reading.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::judging {

/// A fault of a sensor, detected from its readings alone.
enum class ReadingFault : std::uint8_t {
  kNone,
  kSpike,        ///< far from all readings before, and not repeated
  kImplausible,  ///< out of range, or a spike, again and again
  kFrozen,       ///< exactly the same value for too long
  kSeized,       ///< 0 for hours in a wind
};
inline constexpr std::array<std::string_view, 5> kReadingFaultNames = {"none", "spike", "implausible", "frozen",
                                                                       "seized"};

struct JudgeSettings {
  /// A higher speed is out of the sensor's range.
  double max_speed_m_s = kMaxPlausibleSpeed_m_s;
  /// A step is accepted once it has been repeated for as long as a wind of this acceleration needs for it.
  double slew_m_s2 = 5.0;
  /// A reading that differs by less than this, or by less than half the wind, is not a spike.
  double least_spike_m_s = 4.0;
  /// The same value for this many readings, and this long, is frozen; longer for a sensor that often repeats values.
  std::size_t frozen_readings = 20;
  double frozen_s = 30.0;
  /// A sensor that reads 0 for this long has seized, if the other sensors measure wind; a single sensor, after the
  /// longer time, if the last day was windy (nights are calm, too).
  double seized_s = 7200.0;
  double seized_alone_s = 43200.0;
  double windy_m_s = 3.0;
};

/// Checks one sensor's readings one by one, as they arrive: which to accept, and which fault the sensor has.
///
/// Spikes: a reading is suspect if it is further than 5 robust standard deviations (1.4826 times the median of the
/// distances from the median of the last 7), and further than `least_spike_m_s` and half the wind, from that median
/// (Hampel 1974, "The influence curve and its role in robust estimation"); further than twice that, it is suspect
/// whatever the deviation. A suspect is held back; if the following readings agree with it for long enough, or 20
/// times, it was a step and is accepted from then on; otherwise it was a spike and is rejected.
/// Implausible: three of ten of its last 20 or so readings were spikes or out of range, until one of twenty is.
/// Frozen: bit for bit the same speed, direction and gust, above a calm, and ten times longer than the sensor usually
/// keeps a value: one that is polled more often than it measures, or whose resolution is coarse for the wind's
/// turbulence, normally repeats values. One that never sent another value has twenty times the time: it can be a
/// simulator with a steady wind. After ten minutes of silence a freeze and a spike are judged again. Thread-safe: no.
/// Realtime-safe: yes.
class ReadingJudge {
 public:
  explicit ReadingJudge(const JudgeSettings& settings = {}) : settings_(settings) {}

  /// Returns true if the reading is accepted. Readings must be in the order of their times; a late one is rejected.
  /// `others_m_s`: the speed by the other sensors, if there are any.
  bool judge(const Reading& reading, std::optional<double> others_m_s = {}) noexcept;

  /// Counts readings that were already refused as impossible.
  void count_impossible(std::uint64_t readings) noexcept;

  /// Changes the settings; the findings about the sensor are kept.
  void change(const JudgeSettings& settings) noexcept { settings_ = settings; }

  /// The sensor's calibration has changed: its last reading, which was `before`, would be `after`. Earlier readings are
  /// then not compared with later ones, so that the change is not a spike; the times of repetition and standstill, and
  /// the share of bad readings, are kept.
  void recalibrate(const Reading& before, const Reading& after) noexcept;

  /// The present fault: kImplausible, kFrozen or kSeized for as long as it lasts, kSpike while a suspect is held back.
  ReadingFault fault() const noexcept { return fault_; }

  /// Readings that turned out to be spikes.
  std::uint64_t spikes() const noexcept { return spikes_; }

  /// For the fault's reason: number and duration of repetitions of its value; duration of reading 0; share of spikes
  /// and values out of range among its last readings.
  std::size_t same_count() const noexcept { return same_count_; }
  double same_for_s() const noexcept { return same_ ? last_s_ - same_since_s_ : 0.0; }
  double still_for_s() const noexcept { return still_s_; }
  double bad_share() const noexcept { return bad_share_; }

 private:
  static constexpr std::size_t kWindow = 7;

  ReadingFault fault_of(const Reading& reading, double time_s, std::optional<double> others_m_s) noexcept;
  // Each takes the reading, and returns whether it has that fault.
  bool check_spike(Vector wind, double time_s) noexcept;
  bool is_suspect(Vector wind) const noexcept;
  bool is_confirmed(double time_s) const noexcept;
  void dismiss_suspicion() noexcept;
  Vector middle() const noexcept;
  void believe(Vector wind) noexcept;
  void count(bool is_bad) noexcept;
  bool check_frozen(const Reading& reading, double time_s) noexcept;
  double frozen_patience() const noexcept;
  bool check_seized(double speed_m_s, double time_s, std::optional<double> others_m_s) noexcept;

  JudgeSettings settings_;
  std::array<Vector, kWindow> window_{};
  std::size_t believed_ = 0;

  struct Suspicion {
    Vector wind;         ///< the first suspect reading
    double since_s = 0;  ///< and when
    double jump_m_s = 0;
    std::size_t repeats = 0;
  };
  std::optional<Suspicion> suspicion_;

  double bad_share_ = 0.0;
  bool is_implausible_ = false;

  std::optional<Reading> same_;  ///< what is repeated
  double same_since_s_ = 0.0;
  std::size_t same_count_ = 0;
  double resolution_m_s_ = 0.0;        ///< the smallest step; 0: none yet
  std::optional<double> usual_run_s_;  ///< how long it stays with a value; empty: it never left one

  bool is_still_ = false;
  bool is_seized_ = false;
  double still_s_ = 0.0;        ///< duration of its standstill
  double windy_still_s_ = 0.0;  ///< and the part of it in which the others had wind
  double usual_m_s_ = 0.0;      ///< mean speed of the last day in which it moved

  double last_s_ = 0.0;
  bool has_begun_ = false;

  ReadingFault fault_ = ReadingFault::kNone;
  std::uint64_t spikes_ = 0;
};

}  // namespace yuragi::wind::judging
