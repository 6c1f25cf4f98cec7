// What a sensor's faults do to the wind, on real recordings: nothing that would be seen.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/wind/wind_spectrum.hpp"
#include "tests/proof/band_power.hpp"
#include "tests/proof/heard_wind.hpp"
#include "tests/proof/sonic_record.hpp"

namespace yuragi::proof {
namespace {

// What happens in a run of 500 s: the sensor speaks, fails for 100 s, and speaks again.
constexpr double kFaultFrom_s = 300.0;
constexpr double kFaultTo_s = 400.0;
constexpr double kEnd_s = 500.0;
/// Until then an estimator that has just begun is on its way to what the sensor says.
constexpr double kSettled_s = 60.0;
constexpr std::uint64_t kSeeds = 32;
constexpr int kTicksASecond = 60;

using Readings = std::vector<WindReading>;

/// Both recordings as a sensor of 1 s would have told them, up to kEnd_s.
class WindFaults : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    const std::optional<SonicRecord> record = load_sonic(GetParam());
    if (!record) GTEST_SKIP() << "../shared/data/sonic is not here";
    readings_ = block_means(*record, 1.0);
    std::erase_if(readings_, [](const WindReading& reading) { return reading.time.mono > at(kEnd_s); });
  }

  static MonoTime at(double time_s) { return MonoTime(from_seconds(time_s)); }
  static bool is_faulty(const WindReading& reading) {
    return reading.time.mono >= at(kFaultFrom_s) && reading.time.mono < at(kFaultTo_s);
  }

  /// The readings, those of the fault changed; `number` counts them.
  Readings with_fault(const std::function<void(WindReading&, int number)>& change) const {
    Readings result = readings_;
    int number = 0;
    for (WindReading& reading : result) {
      if (is_faulty(reading)) change(reading, number++);
    }
    return result;
  }

  /// The largest steps of normal motion and of a run with a fault, from its begin on: no seed's above the largest of
  /// normal motion, and on average not above its average.
  void expect_no_larger_steps(const std::string& name, const Readings& faulty) const {
    double normal_mean_m_s = 0.0;
    double normal_most_m_s = 0.0;
    double faulty_mean_m_s = 0.0;
    double faulty_most_m_s = 0.0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      HeardWind usual(seed);
      wind_of(usual, readings_, 0.0, kSettled_s);
      const double normal_m_s = largest_step_m_s(wind_of(usual, readings_, kSettled_s, kEnd_s));
      HeardWind heard(seed);
      wind_of(heard, faulty, 0.0, kFaultFrom_s);
      const double faulty_m_s = largest_step_m_s(wind_of(heard, faulty, kFaultFrom_s, kEnd_s));
      normal_mean_m_s += normal_m_s / kSeeds;
      faulty_mean_m_s += faulty_m_s / kSeeds;
      normal_most_m_s = std::max(normal_most_m_s, normal_m_s);
      faulty_most_m_s = std::max(faulty_most_m_s, faulty_m_s);
    }
    fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", GetParam(), name, normal_mean_m_s, normal_most_m_s,
               faulty_mean_m_s, faulty_most_m_s);
    EXPECT_LE(faulty_most_m_s, normal_most_m_s);
    EXPECT_LE(faulty_mean_m_s, normal_mean_m_s);
  }

  Readings readings_;
};

TEST_P(WindFaults, AGapOf100SecondsMovesItNoMore) {
  Readings gap = readings_;
  std::erase_if(gap, is_faulty);
  expect_no_larger_steps("gap of 100 s", gap);
}

TEST_P(WindFaults, NumbersThatAreNoneMoveItNoMore) {
  expect_no_larger_steps("NaN and infinity", with_fault([](WindReading& reading, int number) {
                           const std::array<double, 3> wrong = {std::nan(""), std::numeric_limits<double>::infinity(),
                                                                -std::numeric_limits<double>::infinity()};
                           if (number % 5 == 4) return;
                           (number % 2 == 0 ? reading.speed_m_s : *reading.direction_deg) =
                               wrong.at(static_cast<std::size_t>(number) % 3);
                         }));
}

TEST_P(WindFaults, SpikesMoveItNoMore) {
  expect_no_larger_steps("spikes", with_fault([](WindReading& reading, int number) {
                           if (number % 7 == 0) reading.speed_m_s = 60.0 + number;
                           if (number % 11 == 5)
                             reading.direction_deg = std::fmod(*reading.direction_deg + 180.0, 360.0);
                         }));
}

TEST_P(WindFaults, AFrozenValueMovesItNoMore) {
  WindReading last;
  for (const WindReading& reading : readings_) {
    if (reading.time.mono < at(kFaultFrom_s)) last = reading;
  }
  expect_no_larger_steps("frozen value", with_fault([&last](WindReading& reading, int) {
                           reading.speed_m_s = last.speed_m_s;
                           reading.direction_deg = last.direction_deg;
                         }));
}

TEST_P(WindFaults, ARestartMovesItNoMore) {
  // What went before is not known to the new one: it is new itself.
  double normal_m_s = 0.0;
  double restarted_m_s = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    HeardWind usual(seed);
    wind_of(usual, readings_, 0.0, kSettled_s);
    normal_m_s = std::max(normal_m_s, largest_step_m_s(wind_of(usual, readings_, kSettled_s, kEnd_s)));
    HeardWind restarted(seed + 1000);
    restarted_m_s = std::max(restarted_m_s, largest_step_m_s(wind_of(restarted, readings_, kFaultFrom_s, kEnd_s)));
  }
  fmt::print("| {} | restart | | {:.3f} | | {:.3f} |\n", GetParam(), normal_m_s, restarted_m_s);
  EXPECT_LE(restarted_m_s, normal_m_s);
}

TEST_P(WindFaults, AClockThatIsSetDoesNotMoveIt) {
  for (const int years : {-10, 10}) {
    const Readings set =
        with_fault([years](WindReading& reading, int) { reading.time.utc += std::chrono::years(years); });
    HeardWind usual(1);
    HeardWind heard(1);
    const std::vector<WindVector> expected = wind_of(usual, readings_, 0.0, kEnd_s);
    const std::vector<WindVector> winds = wind_of(heard, set, 0.0, kEnd_s);
    ASSERT_EQ(winds.size(), expected.size());
    for (std::size_t i = 0; i < winds.size(); ++i) {
      ASSERT_EQ(winds[i].u_m_s, expected[i].u_m_s);
      ASSERT_EQ(winds[i].v_m_s, expected[i].v_m_s);
    }
  }
}

TEST_P(WindFaults, AClockThatLeapsTenYearsMovesItNoMore) {
  // The clock that only grows leaps as well; the sensor goes on in the new time.
  const Nanoseconds leap = std::chrono::years(10);
  double normal_m_s = 0.0;
  double leaping_m_s = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    HeardWind heard(seed);
    wind_of(heard, readings_, 0.0, kSettled_s);
    std::vector<WindVector> winds = wind_of(heard, readings_, kSettled_s, kFaultFrom_s);
    normal_m_s = std::max(normal_m_s, largest_step_m_s(winds));
    winds.erase(winds.begin(), winds.end() - 1);
    auto next = std::ranges::find_if(readings_, is_faulty);
    for (int tick = 0; tick < 100 * kTicksASecond; ++tick) {
      const MonoTime now = at(kFaultFrom_s) + from_seconds(tick / 60.0);
      for (; next != readings_.end() && next->time.mono <= now; ++next) {
        WindReading later = *next;
        later.time.mono += leap;
        heard.tell(later);
      }
      winds.push_back(heard.advance(now + leap));
    }
    // Back again: time that is over is not lived again.
    const WindVector before = winds.back();
    winds.push_back(heard.advance(at(kFaultTo_s)));
    EXPECT_EQ(winds.back().u_m_s, before.u_m_s);
    leaping_m_s = std::max(leaping_m_s, largest_step_m_s(winds));
  }
  fmt::print("| {} | clock leaps 10 years | | {:.3f} | | {:.3f} |\n", GetParam(), normal_m_s, leaping_m_s);
  EXPECT_LE(leaping_m_s, normal_m_s);
}

/// The part of von Karman's variance that is seen within a window: what is slower than it is its mean.
double seen_in(double window_s, const Turbulence& turbulence) {
  const auto spectrum = WindSpectrum::make({.speed_m_s = 1.0, .sigma_m_s = 1.0, .length_m = turbulence.time_scale_s});
  double seen = 0.0;
  constexpr double kStep = 0.01;
  for (double log_hz = std::log(1e-5); log_hz < std::log(1e2); log_hz += kStep) {
    const double frequency_hz = std::exp(log_hz);
    const double angle = std::numbers::pi * frequency_hz * window_s;
    const double mean = std::sin(angle) / angle;
    seen += spectrum.value().density_m2_s2_hz(frequency_hz) * (1.0 - mean * mean) * frequency_hz * kStep;
  }
  return seen;
}

TEST_P(WindFaults, InAGapItGoesOnAsTheModelDoes) {
  Readings gap = readings_;
  std::erase_if(gap, is_faulty);
  double along_m2_s2 = 0.0;
  double model_m2_s2 = 0.0;
  double both_m2_s2 = 0.0;
  double usual_m2_s2 = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    HeardWind heard(seed);
    const std::vector<WindVector> before = wind_of(heard, gap, 0.0, kFaultFrom_s);
    // The last 100 s before the gap, and the gap.
    const std::vector<WindVector> last(before.end() - 100 * kTicksASecond, before.end());
    const Turbulence turbulence = heard.estimator().turbulence();
    const WindVector ahead = heard.estimator().ground().gusts.ahead;
    const WindMoments usual = moments_of(last);
    std::vector<WindVector> winds = wind_of(heard, gap, kFaultFrom_s, kFaultTo_s);
    const WindMoments both = moments_of(winds);
    for (WindVector& wind : winds) wind = {wind.u_m_s * ahead.u_m_s + wind.v_m_s * ahead.v_m_s, 0.0};
    const double sigma_m_s = turbulence.intensity * speed_of(usual.mean);
    model_m2_s2 += sigma_m_s * sigma_m_s * seen_in(kFaultTo_s - kFaultFrom_s, turbulence) / kSeeds;
    along_m2_s2 += moments_of(winds).variance_m2_s2 / kSeeds;
    both_m2_s2 += both.variance_m2_s2 / kSeeds;
    usual_m2_s2 += usual.variance_m2_s2 / kSeeds;
  }
  fmt::print(
      "| {} | variance in a gap of 100 s: along {:.3f}, model {:.3f} m^2/s^2: {:.2f}; u + v {:.3f}, in the 100 s "
      "before {:.3f} |\n",
      GetParam(), along_m2_s2, model_m2_s2, along_m2_s2 / model_m2_s2, both_m2_s2, usual_m2_s2);
  EXPECT_GE(along_m2_s2, 0.8 * model_m2_s2);
  EXPECT_LE(along_m2_s2, 1.5 * model_m2_s2);
}

INSTANTIATE_TEST_SUITE_P(Records, WindFaults, testing::Values(0, 1));

}  // namespace
}  // namespace yuragi::proof
