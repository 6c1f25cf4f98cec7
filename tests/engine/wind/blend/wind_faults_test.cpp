// Random sequences of faults on the way that readings take in the daemon: what is no wind is refused, what the judge
// does not believe is held back, the estimator hears the rest.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "engine/wind/blend/blended_estimator.hpp"
#include "engine/wind/judging/reading_judge.hpp"
#include "engine/wind/turbulence/synthetic_wind.hpp"

namespace yuragi::wind::blend {
namespace {

constexpr double kFaultyTick_s = 1.0 / 30.0;

enum class RandomFault : std::uint8_t {
  kNone,
  kSilence,
  kNotANumber,
  kSpike,
  kFrozen,
  kZero,
  kNoDirection,
  kTurnedAbout,
  kEarlier,  ///< the readings' clock is behind, or runs ahead
  kLater,
  kTwice,
  kCount,
};

/// A sensor of a synthetic wind that breaks in a new way every now and then.
class FaultySensor {
 public:
  explicit FaultySensor(std::uint64_t seed)
      : random_(seed), wind_({.mean_speed_m_s = 7.0, .mean_direction_deg = 350.0, .seed = seed}) {}

  /// Says what it says at a time: nothing, a reading, or two.
  template <class Tell>
  void speak(double time_s, Tell tell) {
    if (time_s < next_s_) return;
    next_s_ = time_s + interval_s_;
    if (time_s >= until_s_) {
      fault_ = random_() % 2 == 0 ? RandomFault::kNone
                                  : static_cast<RandomFault>(random_() % static_cast<unsigned>(RandomFault::kCount));
      until_s_ = time_s + 1.0 + static_cast<double>(random_() % 60);
      interval_s_ = std::array{0.1, 1.0, 1.0, 5.0, 14.0}.at(random_() % 5);
    }
    if (fault_ == RandomFault::kSilence) return;
    const Reading reading = broken(time_s);
    tell(reading);
    if (fault_ == RandomFault::kTwice) tell(reading);
  }

 private:
  Reading broken(double time_s) {
    const Vector wind = wind_.at(time_s);
    Reading reading;
    reading.time.mono = MonoTime(from_seconds(time_s));
    reading.speed_m_s = speed_of(wind);
    reading.direction_deg = direction_from_deg(wind);
    switch (fault_) {
      case RandomFault::kNotANumber: {
        const std::array<double, 4> wrong = {std::nan(""), std::numeric_limits<double>::infinity(), -1.0, 1e300};
        (random_() % 2 == 0 ? reading.speed_m_s : *reading.direction_deg) = wrong.at(random_() % wrong.size());
        break;
      }
      case RandomFault::kSpike:
        if (random_() % 4 == 0) reading.speed_m_s = static_cast<double>(random_() % 120);
        break;
      case RandomFault::kFrozen:
        return Reading{.time = reading.time, .speed_m_s = 6.5, .direction_deg = 12.0, .gust_m_s = {}, .quality = {}};
      case RandomFault::kZero:
        reading.speed_m_s = 0.0;
        break;
      case RandomFault::kNoDirection:
        reading.direction_deg.reset();
        break;
      case RandomFault::kTurnedAbout:
        reading.direction_deg = static_cast<double>(random_() % 360);
        break;
      case RandomFault::kEarlier:
        reading.time.mono -= from_seconds(static_cast<double>(random_() % 100));
        break;
      case RandomFault::kLater:
        reading.time.mono += from_seconds(static_cast<double>(random_() % 5));
        break;
      default:
        break;
    }
    return reading;
  }

  std::mt19937_64 random_;
  turbulence::SyntheticWind wind_;
  RandomFault fault_ = RandomFault::kNone;
  double until_s_ = 0.0, next_s_ = 0.0, interval_s_ = 1.0;
};

bool is_finite(Vector wind) {
  return std::isfinite(wind.u_m_s) && std::isfinite(wind.v_m_s);
}

TEST(WindFaults, RandomSequencesLeaveItFiniteAndBounded) {
  const auto noise = std::make_shared<const turbulence::GustNoise>(turbulence::GustNoiseSettings{.samples = 128});
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    FaultySensor sensor(seed);
    judging::ReadingJudge judge;
    BlendedEstimator estimator(1, {.climate = {.seed = seed}}, noise);
    double strongest_m_s = 4.0;  // that was believed, or is the climate's
    for (int tick = 0; tick * kFaultyTick_s < 400.0; ++tick) {
      const double time_s = tick * kFaultyTick_s;
      sensor.speak(time_s, [&](const Reading& reading) {
        if (!is_plausible(reading) || !judge.judge(reading)) return;
        if (estimator.accept(0, reading)) strongest_m_s = std::max(strongest_m_s, reading.speed_m_s);
      });
      const State state = estimator.advance(MonoTime(from_seconds(time_s)));
      ASSERT_TRUE(is_finite(state.wind)) << "seed " << seed << " at " << time_s << " s";
      ASSERT_LE(speed_of(state.wind), 3.0 * strongest_m_s) << "seed " << seed << " at " << time_s << " s";
      ASSERT_TRUE(state.live_weight >= 0.0 && state.live_weight <= 1.0);
      for (const double away_m : {-30.0, 30.0}) {
        const Vector blade = estimator.ground().at(*noise, away_m, 2.0);
        ASSERT_TRUE(is_finite(blade)) << "seed " << seed << " at " << time_s << " s";
        ASSERT_LE(speed_of(blade), 3.0 * strongest_m_s) << "seed " << seed << " at " << time_s << " s";
      }
    }
  }
}

TEST(WindFaults, ADirectionPassesThroughNorthAtEveryPlace) {
  // What is known of the wind: everything but the noise, which is known, too. At the sensor and at two other places.
  const auto noise = std::make_shared<const turbulence::GustNoise>(turbulence::GustNoiseSettings{.samples = 128});
  for (const double interval_s : {0.1, 1.0, 14.0}) {
    BlendedEstimator estimator(1, {.climate = {.mean_speed_m_s = 6.0, .mean_direction_deg = 350.0}}, noise);
    double next_s = 0.0;
    double nearest_deg = 180.0;
    for (int tick = 0; tick * kFaultyTick_s < 400.0; ++tick) {
      const double time_s = tick * kFaultyTick_s;
      const MonoTime now(from_seconds(time_s));
      if (time_s >= next_s) {
        Reading reading;
        reading.time.mono = now;
        reading.speed_m_s = 6.0;
        reading.direction_deg = time_s < 200.0 ? 350.0 : 10.0;
        ASSERT_TRUE(estimator.accept(0, reading));
        next_s += interval_s;
      }
      estimator.advance(now);
      const ground::Wind& ground = estimator.ground();
      for (const double away_m : {0.0, -30.0, 30.0}) {
        const Vector known = ground.at(*noise, away_m, away_m) - noise->local(ground.gusts, away_m, away_m) -
                             noise->everywhere(ground.gusts);
        const double from_deg = direction_from_deg(known);
        const double off_north_deg = std::min(from_deg, 360.0 - from_deg);
        ASSERT_LE(off_north_deg, 10.01) << interval_s << " s, at " << time_s << " s";
        ASSERT_GT(speed_of(known), 5.8);
        nearest_deg = std::min(nearest_deg, off_north_deg);
      }
    }
    EXPECT_LT(nearest_deg, 5.0) << interval_s << " s: it passes through north";
    EXPECT_GT(direction_from_deg(estimator.ground().gusts.ahead), 0.0);
    EXPECT_LT(direction_from_deg(estimator.ground().gusts.ahead), 10.01) << "and the gusts go with it";
  }
}

}  // namespace
}  // namespace yuragi::wind::blend
