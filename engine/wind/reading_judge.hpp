#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/wind/wind_reading.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi {

/// What is wrong with what a sensor says, seen from the readings alone.
enum class ReadingFault : std::uint8_t {
  kNone,
  kSpike,   ///< far from all that came before, and not said again
  kFrozen,  ///< exactly the same again and again, while a wind that is no calm never is
  kSeized,  ///< nothing for hours where a wind blows
};
inline constexpr std::array<std::string_view, 4> kReadingFaultNames = {"none", "spike", "frozen", "seized"};

struct JudgeSettings {
  /// A step is believed when it has been said again for as long as a wind of this acceleration would take to make it.
  double slew_m_s2 = 5.0;
  /// What differs by less than this and half the wind is no spike.
  double least_spike_m_s = 4.0;
  /// The same for so many readings, and for so long, is frozen.
  std::size_t frozen_readings = 20;
  double frozen_s = 30.0;
  /// A calm for so long is a seizure where the other sensors say that it is windy; alone, a calm for so long where the
  /// last day was (nights are calm, too).
  double seized_s = 7200.0;
  double seized_alone_s = 43200.0;
  double windy_m_s = 3.0;
};

/// Judges one sensor's readings one by one, as they come: which to believe, and what is wrong with the sensor.
///
/// Spikes: a reading is suspect if it is further than 5 robust standard deviations (1.4826 times the median of the
/// distances from the median of the last 7), and further than `least_spike_m_s` and half the wind, from that median
/// (Hampel 1974, "The influence curve and its role in robust estimation"). A suspect is held back; if what follows
/// says the same for long enough it was a step, and is believed from then on; otherwise it was a spike, and is not.
/// Frozen: bit for bit the same speed and direction, above a calm; a sensor whose resolution is coarse for the wind's
/// turbulence may repeat itself ten times as long. Thread-safe: no. Realtime-safe: yes.
class ReadingJudge {
 public:
  explicit ReadingJudge(const JudgeSettings& settings = {}) : settings_(settings) {}

  /// Is it to be believed? Readings come in the order of their times. `windy_m_s`: what the other sensors say of the
  /// wind, where there are any.
  bool judge(const WindReading& reading, std::optional<double> others_m_s = {}) noexcept;

  /// What is wrong at the moment: kFrozen or kSeized for as long as it lasts, kSpike while a suspect is held back.
  ReadingFault fault() const noexcept { return fault_; }

  /// Readings that turned out to be spikes.
  std::uint64_t spikes() const noexcept { return spikes_; }

 private:
  static constexpr std::size_t kWindow = 7;

  bool is_suspect(WindVector wind) const noexcept;
  WindVector middle() const noexcept;
  bool is_confirmed(double time_s) const noexcept;
  void believe(WindVector wind) noexcept;
  bool is_frozen(const WindReading& reading, double time_s) noexcept;
  bool is_seized(const WindReading& reading, double time_s, std::optional<double> others_m_s) noexcept;

  JudgeSettings settings_;
  std::array<WindVector, kWindow> window_{};
  std::size_t believed_ = 0;

  struct Suspicion {
    WindVector wind;     ///< what was said first
    double since_s = 0;  ///< and when
    double jump_m_s = 0;
    std::size_t repeats = 0;
  };
  std::optional<Suspicion> suspicion_;

  std::optional<WindReading> same_;  ///< what is repeated
  double same_since_s_ = 0.0;
  std::size_t same_count_ = 0;
  double resolution_m_s_ = 0.0;  ///< the smallest step seen; 0: none yet

  std::optional<double> calm_since_s_;
  double usual_m_s_ = 0.0;  ///< mean speed of the last day in which it moved
  double last_s_ = 0.0;
  bool has_begun_ = false;

  ReadingFault fault_ = ReadingFault::kNone;
  std::uint64_t spikes_ = 0;
};

}  // namespace yuragi
