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
  /// Faster than this is out of the sensor's range.
  double max_speed_m_s = kMaxPlausibleSpeed_m_s;
  /// A step is accepted once it has been repeated for as long as a wind of this acceleration would take to make it.
  double slew_m_s2 = 5.0;
  /// What differs by less than this and half the wind is no spike.
  double least_spike_m_s = 4.0;
  /// The same for so many readings, and for so long, is frozen; longer where the sensor is one that repeats itself.
  std::size_t frozen_readings = 20;
  double frozen_s = 30.0;
  /// A sensor that reads 0 for so long has seized, if the other sensors measure wind; a single sensor, after the longer
  /// time, if the last day was windy (nights are calm, too).
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
/// stays with a value: one that is asked more often than it measures, or whose resolution is coarse for the wind's
/// turbulence, repeats itself by nature. One that never sent another value has twenty times the time: it may be a
/// simulator whose wind is steady. After ten minutes of silence a freeze and a spike are judged anew.
/// Thread-safe: no. Realtime-safe: yes.
class ReadingJudge {
 public:
  explicit ReadingJudge(const JudgeSettings& settings = {}) : settings_(settings) {}

  /// True: accept the reading. Readings come in the order of their times; one that is late is rejected. `others_m_s`:
  /// the speed by the other sensors, if there are any.
  bool judge(const WindReading& reading, std::optional<double> others_m_s = {}) noexcept;

  /// Counts readings that were refused before they came here as impossible.
  void count_impossible(std::uint64_t readings) noexcept;

  /// Judges by other settings from now on; what was found out about the sensor stays.
  void change(const JudgeSettings& settings) noexcept { settings_ = settings; }

  /// The sensor's calibration has changed: its last reading, which was `before`, would be `after`. Readings until now
  /// are no measure for the height of those that follow, so that the change is no spike; how long the sensor has
  /// repeated its value or stood still, and how many of its readings were bad, stays known.
  void recalibrate(const WindReading& before, const WindReading& after) noexcept;

  /// What is wrong at the moment: kImplausible, kFrozen or kSeized for as long as it lasts, kSpike while a suspect is
  /// held back.
  ReadingFault fault() const noexcept { return fault_; }

  /// Readings that turned out to be spikes.
  std::uint64_t spikes() const noexcept { return spikes_; }

  /// For the fault's reason: how often and for how long it has repeated its value; for how long it has read 0; which
  /// part of its last readings were spikes or out of range.
  std::size_t same_count() const noexcept { return same_count_; }
  double same_for_s() const noexcept { return same_ ? last_s_ - same_since_s_ : 0.0; }
  double still_for_s() const noexcept { return still_s_; }
  double bad_share() const noexcept { return bad_share_; }

 private:
  static constexpr std::size_t kWindow = 7;

  ReadingFault fault_of(const WindReading& reading, double time_s, std::optional<double> others_m_s) noexcept;
  // Each takes the reading, and returns whether it has that fault.
  bool check_spike(WindVector wind, double time_s) noexcept;
  bool is_suspect(WindVector wind) const noexcept;
  bool is_confirmed(double time_s) const noexcept;
  void dismiss_suspicion() noexcept;
  WindVector middle() const noexcept;
  void believe(WindVector wind) noexcept;
  void count(bool is_bad) noexcept;
  bool check_frozen(const WindReading& reading, double time_s) noexcept;
  double frozen_patience() const noexcept;
  bool check_seized(double speed_m_s, double time_s, std::optional<double> others_m_s) noexcept;

  JudgeSettings settings_;
  std::array<WindVector, kWindow> window_{};
  std::size_t believed_ = 0;

  struct Suspicion {
    WindVector wind;     ///< the first suspect reading
    double since_s = 0;  ///< and when
    double jump_m_s = 0;
    std::size_t repeats = 0;
  };
  std::optional<Suspicion> suspicion_;

  double bad_share_ = 0.0;
  bool is_implausible_ = false;

  std::optional<WindReading> same_;  ///< what is repeated
  double same_since_s_ = 0.0;
  std::size_t same_count_ = 0;
  double resolution_m_s_ = 0.0;        ///< the smallest step seen; 0: none yet
  std::optional<double> usual_run_s_;  ///< how long it stays with a value; empty: it never left one

  bool is_still_ = false;
  bool is_seized_ = false;
  double still_s_ = 0.0;        ///< how long it has stood still
  double windy_still_s_ = 0.0;  ///< and of this, while the others had wind
  double usual_m_s_ = 0.0;      ///< mean speed of the last day in which it moved

  double last_s_ = 0.0;
  bool has_begun_ = false;

  ReadingFault fault_ = ReadingFault::kNone;
  std::uint64_t spikes_ = 0;
};

}  // namespace yuragi::wind::judging
