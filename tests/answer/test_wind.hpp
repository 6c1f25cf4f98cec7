#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::answer {

/// The Beaufort numbers of the tables, and what they stand for: the mean wind in the middle of each number's range.
inline constexpr std::size_t kBeauforts = 4;
inline constexpr std::array<int, kBeauforts> kBeaufort = {1, 3, 5, 7};
inline constexpr std::array<double, kBeauforts> kMeanSpeed_m_s = {0.9, 4.4, 9.4, 15.5};

inline constexpr double kTick_s = 1.0 / 60.0;
inline constexpr double kRate_hz = 60.0;

struct TestWindSettings {
  double speed_m_s = 4.4;
  double direction_deg = 0.0;  ///< where it comes from
  double intensity = 0.2;      ///< standard deviation along the wind over its mean speed, of a long record
  double length_m = 57.0;      ///< integral length scale
  double shortest_wave_m = 2.0;
  std::uint64_t seed = 1;  ///< where in the noise it begins
};

/// The wind that scenes are measured in: a fixed ground::Wind, the same everywhere but for its gusts, which are the
/// wind's own noise with von Karman's spectrum (gust_variances), carried by the mean wind, turning over as the
/// daemon's. Waves whose octave lies below `shortest_wave_m` are left out, so that nothing in it is quicker than half
/// its speed in Hz. Across the wind gusts have 0.8 of what they have along it (IEC 61400-1).
class TestWind {
 public:
  TestWind(std::shared_ptr<const wind::turbulence::GustNoise> noise, const TestWindSettings& settings);

  /// The wind of the next tick.
  const wind::ground::Wind& step(double dt_s) noexcept;

  /// What blows at the origin, as a frame of the stream says it.
  wind::Vector at_origin() const noexcept { return wind_.at(*noise_, 0.0, 0.0); }

 private:
  std::shared_ptr<const wind::turbulence::GustNoise> noise_;
  wind::Vector mean_;
  double turnover_m23_s_;
  wind::ground::Wind wind_;
  std::uint64_t tick_ = 0;
};

/// The noise of all test winds: large, and made once.
std::shared_ptr<const wind::turbulence::GustNoise> test_gusts();

/// The place in the noise at which the record of a Beaufort number begins: one where the mean and the intensity of the
/// record are near those of the settings. Of few gusts, as a record of minutes has them, both scatter.
std::uint64_t wind_seed(std::size_t beaufort_index) noexcept;

}  // namespace yuragi::answer
