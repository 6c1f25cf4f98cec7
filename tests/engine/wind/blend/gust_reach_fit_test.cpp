#include "engine/wind/blend/gust_reach_fit.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/wind/blend/blended_estimator.hpp"
#include "engine/wind/turbulence/von_karman.hpp"

namespace yuragi::wind::blend {
namespace {

using turbulence::OctaveFollower;

constexpr double kTick_s = 0.1;

/// Gusts of W5 at two places, of which those of the second are those of the first after the wind's way, as far as the
/// law lets them with the given decay, and their own for the rest. One component is enough of each.
class Pair {
 public:
  struct Where {
    double along_m = 0.0, across_m = 0.0;
  };

  Pair(Where where, double reach_across, double reach_along, ground::GustCoherence law = {.speed_m_s = 5.0})
      : where_(where), law_(law) {
    stroke_.coherence = law;
    stroke_.ahead = {1.0, 0.0};
    stroke_.pen_count = 2;
    for (ground::WindPen& pen : stroke_.pens) pen.weights.fill(1.0);
    ground::GustCoherence real = law;
    real.decay_across /= reach_across;
    real.decay_along /= reach_along;
    const math::RandomStream random(7, math::stream_id("pair"));
    constexpr int kModes = 240;
    const double log_step = std::log(2000.0) / kModes;
    for (int k = 0; k < kModes; ++k) {
      const auto key = static_cast<std::uint64_t>(k);
      // Both have modes of their own frequencies, so that nothing of them is alike by chance for long.
      const auto mode = [&](std::uint64_t number) {
        const double frequency_hz = 0.002 * std::exp(log_step * (k + random.uniform(number)));
        const double amplitude =
            std::sqrt(turbulence::von_karman_density(frequency_hz * law.length_m / law.speed_m_s) * frequency_hz);
        return Mode{.turn = std::polar(1.0, 2.0 * std::numbers::pi * frequency_hz * kTick_s),
                    .left = std::exp(-real.distance_m(where.along_m, where.across_m) * real.loss_per_m(frequency_hz)),
                    .value = std::polar(amplitude, 2.0 * std::numbers::pi * random.uniform(number + 1))};
      };
      common_.push_back(mode(4 * key));
      carried_.push_back(common_.back());
      carried_.back().value *= common_.back().left;
      own_.push_back(mode(4 * key + 2));
      own_.back().value *= std::sqrt(1.0 - own_.back().left * own_.back().left);
    }
    turn(carried_, -where.along_m / law.speed_m_s);
  }

  /// Of the second place: its readings are late.
  void delay(double late_s) {
    late_s_ = late_s;
    turn(carried_, -late_s);
  }

  ground::WindStroke& stroke() { return stroke_; }

  /// The places are known, or not.
  const GustReach& run(double duration_s, GustReachFit& fit, bool is_known = true) {
    const OctaveFollower::Parts parts = OctaveFollower::parts(kTick_s);
    const int ticks = static_cast<int>(duration_s / kTick_s);
    for (int tick = 0; tick < ticks; ++tick) {
      const Complex first = next(common_);
      const Complex second = next(carried_) + next(own_);
      followers_[0].step({first.real(), first.imag()}, parts);
      followers_[1].step({second.real(), second.imag()}, parts);
      const double way_m = law_.speed_m_s * kTick_s;
      stroke_.way_m += way_m;
      stroke_.carried_east_m += way_m;
      for (std::size_t place = 0; place < 2; ++place) {
        for (std::size_t band = 0; band < OctaveFollower::kBands; ++band) {
          const Vector gust = followers_[place].band(band);
          stroke_.pens[place].now.east_m_s[band] = static_cast<float>(gust.u_m_s);
          stroke_.pens[place].now.north_m_s[band] = static_cast<float>(gust.v_m_s);
        }
      }
      // As the estimator does, with what is learnt.
      stroke_.coherence.decay_across = law_.decay_across * std::exp(-fit.reach().across_ln);
      stroke_.coherence.decay_along = law_.decay_along * std::exp(-fit.reach().along_ln);
      const std::array places{
          GustReachFit::Place{.pen = is_known ? stroke_.pens.data() : nullptr},
          GustReachFit::Place{
              .east_m = where_.along_m, .south_m = -where_.across_m, .delay_s = late_s_, .pen = &stroke_.pens[1]}};
      fit.advance(kTick_s, stroke_, places);
    }
    return fit.reach();
  }

 private:
  using Complex = std::complex<double>;
  struct Mode {
    Complex turn;
    double left = 1.0;
    Complex value;
  };

  static void turn(std::vector<Mode>& modes, double time_s) {
    for (Mode& mode : modes) mode.value *= std::polar(1.0, std::arg(mode.turn) / kTick_s * time_s);
  }
  static Complex next(std::vector<Mode>& modes) {
    Complex sum;
    for (Mode& mode : modes) sum += mode.value *= mode.turn;
    return sum;
  }

  Where where_;
  ground::GustCoherence law_;
  ground::WindStroke stroke_;
  std::vector<Mode> common_, carried_, own_;
  std::array<OctaveFollower, 2> followers_;
  double late_s_ = 0.0;
};

TEST(GustReachFit, LearnsHowFarGustsReachAcrossTheWind) {
  for (const double times : {0.5, 1.0, 2.0}) {
    GustReachFit fit(2);
    Pair pair({.across_m = 6.0}, times, 1.0);
    const GustReach reach = pair.run(7200.0, fit);
    EXPECT_NEAR(std::exp(reach.across_ln) / times, 1.0, 0.15) << times;
    EXPECT_LT(std::sqrt(reach.across_variance), 0.15) << times;
    EXPECT_LT(std::abs(reach.across_ln - std::log(times)), 3.0 * std::sqrt(reach.across_variance)) << times;
    // A pair across the wind shows nothing of how far gusts reach along it.
    EXPECT_EQ(reach.along_ln, 0.0);
    EXPECT_EQ(reach.along_variance, GustReach::kPriorVariance);
    EXPECT_EQ(reach.across(), std::exp(reach.across_ln));
    EXPECT_EQ(reach.along(), std::nullopt);
  }
}

TEST(GustReachFit, LearnsHowFarGustsReachAlongTheWindAfterTheirWay) {
  for (const double along_m : {12.0, -12.0}) {
    for (const double times : {0.5, 2.0}) {
      GustReachFit fit(2);
      Pair pair({.along_m = along_m}, 1.0, times, {.speed_m_s = 5.0, .decay_along = 2.0});
      const GustReach reach = pair.run(7200.0, fit);
      EXPECT_NEAR(std::exp(reach.along_ln) / times, 1.0, 0.2) << along_m << " m, " << times;
      EXPECT_EQ(reach.across_ln, 0.0);
    }
  }
}

TEST(GustReachFit, ReadingsOfTwoKindsAreComparedAtTheTimeOfTheWind) {
  for (const double along_m : {12.0, -12.0}) {
    GustReachFit fit(2);
    Pair pair({.along_m = along_m}, 1.0, 2.0, {.speed_m_s = 5.0, .decay_along = 2.0});
    pair.delay(3.0);
    EXPECT_NEAR(std::exp(pair.run(7200.0, fit).along_ln), 2.0, 0.4) << along_m;
  }
}

TEST(GustReachFit, IsBounded) {
  {
    GustReachFit fit(2);
    Pair alike({.across_m = 30.0}, 1e6, 1.0);
    EXPECT_NEAR(std::exp(alike.run(7200.0, fit).across_ln), GustReach::kMaxFactor, 0.1);
  }
  GustReachFit fit(2);
  Pair strangers({.across_m = 1.0}, 1e-6, 1.0);
  const GustReach reach = strangers.run(7200.0, fit);
  EXPECT_NEAR(std::exp(reach.across_ln), 1.0 / GustReach::kMaxFactor, 0.02);
  EXPECT_TRUE(is_valid(reach));
}

TEST(GustReachFit, LearnsNothingFromWhatIsNotKnown) {
  const auto nothing = [](Pair& pair, double duration_s, bool is_known = true) {
    GustReachFit fit(2);
    return pair.run(duration_s, fit, is_known) == GustReach{};
  };
  Pair without_place({.across_m = 6.0}, 2.0, 1.0);
  EXPECT_TRUE(nothing(without_place, 1000.0, false));
  Pair young({.across_m = 6.0}, 2.0, 1.0);
  EXPECT_TRUE(nothing(young, 250.0));
  Pair calm({.across_m = 6.0}, 2.0, 1.0, {.speed_m_s = 0.3});
  EXPECT_TRUE(nothing(calm, 1000.0));
  Pair unresolved({.across_m = 6.0}, 2.0, 1.0);
  unresolved.stroke().pens[1].weights.fill(0.5);
  EXPECT_TRUE(nothing(unresolved, 1000.0));
}

TEST(GustReachFit, GoesOnFromWhatWasLearntAndFromNothingElse) {
  GustReachFit fit(2);
  const GustReach learnt{.across_ln = 0.4, .along_ln = -0.2, .across_variance = 0.01, .along_variance = 0.02};
  ASSERT_TRUE(fit.restore(learnt));
  EXPECT_EQ(fit.reach(), learnt);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const GustReach& wrong :
       {GustReach{.across_ln = 1.2}, GustReach{.along_ln = -1.2}, GustReach{.across_ln = nan},
        GustReach{.across_variance = 0.0}, GustReach{.along_variance = 0.3}, GustReach{.along_variance = nan}}) {
    EXPECT_FALSE(fit.restore(wrong));
    EXPECT_EQ(fit.reach(), learnt);
  }
}

/// A wind from the south whose gusts are `reach` times as far alike across it as by the law, at three places side by
/// side, 3 m apart: the outer ones have sensors of ten readings a second.
class ThreePlaces {
 public:
  static constexpr double kApart_m = 3.0;
  static constexpr double kMean_m_s = 5.0;

  explicit ThreePlaces(double reach) {
    const math::RandomStream random(11, math::stream_id("three places"));
    ground::GustCoherence law{.speed_m_s = kMean_m_s};
    law.decay_across /= reach;
    constexpr int kModes = 200;
    const double log_step = std::log(1000.0) / kModes;
    double power = 0.0;
    for (int k = 0; k < kModes; ++k) {
      double left = 1.0;
      for (std::size_t place = 0; place < 3; ++place) {
        const std::uint64_t number = 2 * (3 * static_cast<std::uint64_t>(k) + place);
        const double frequency_hz = 0.002 * std::exp(log_step * (k + random.uniform(number)));
        const double amplitude =
            std::sqrt(turbulence::von_karman_density(frequency_hz * law.length_m / kMean_m_s) * frequency_hz);
        // What a place has of its own; then what the next one has of it is `left`: exponential, so that is enough.
        const double own = place == 0 ? 1.0 : std::sqrt(1.0 - left * left);
        left = std::exp(-law.distance_m(0.0, kApart_m) * law.loss_per_m(frequency_hz));
        modes_.push_back({.turn = std::polar(1.0, 2.0 * std::numbers::pi * frequency_hz * kTick_s),
                          .value = std::polar(amplitude * own, 2.0 * std::numbers::pi * random.uniform(number + 1)),
                          .left = left,
                          .from = place});
        power += 0.5 * amplitude * amplitude / 3.0;
      }
    }
    scale_ = 0.2 * kMean_m_s / std::sqrt(power);
  }

  /// Their gusts along the wind at the next tick.
  std::array<double, 3> next() {
    std::array<double, 3> gusts{};
    for (Mode& mode : modes_) {
      mode.value *= mode.turn;
      double gust = scale_ * mode.value.real();
      for (std::size_t place = mode.from; place < 3; ++place, gust *= mode.left) gusts[place] += gust;
    }
    return gusts;
  }

 private:
  struct Mode {
    std::complex<double> turn, value;
    double left = 1.0;
    std::size_t from = 0;
  };
  std::vector<Mode> modes_;
  double scale_ = 1.0;
};

/// The mean square of what the wind between the sensors lacks of the real one there, in the second half of an hour.
double error_between(double reach, bool learns) {
  Settings settings;
  settings.climate.turbulence_intensity = 0.2;
  settings.rate_hz = 1.0 / kTick_s;
  for (const double east_m : {-ThreePlaces::kApart_m, ThreePlaces::kApart_m})
    settings.sources.push_back({.priority = 1, .has_place = true, .east_m = east_m});
  static const auto kNoise =
      std::make_shared<const turbulence::GustNoise>(turbulence::GustNoiseSettings{.samples = 128});
  BlendedEstimator estimator(2, settings, kNoise);
  if (!learns) {
    EXPECT_TRUE(estimator.restore_reach({.across_variance = 1e-12, .along_variance = 1e-12}));
  }
  ground::WindTapes tapes(2);
  ThreePlaces wind(reach);
  double squares = 0.0;
  constexpr int kTicks = 36'000;
  for (int tick = 0; tick < kTicks; ++tick) {
    const MonoTime now(from_seconds(tick * kTick_s));
    const std::array<double, 3> gusts = wind.next();
    for (const std::size_t source : {0U, 1U}) {
      Reading reading;
      reading.time.mono = now;
      reading.speed_m_s = std::max(ThreePlaces::kMean_m_s + gusts[2 * source], 0.0);
      reading.direction_deg = 180.0;
      estimator.accept(source, reading);
    }
    ground::DrivingWind driving;
    driving.state = estimator.advance(now);
    driving.ground = estimator.ground();
    driving.stroke = estimator.stroke();
    const ground::Wind ground = written_to(tapes, driving);
    if (tick < kTicks / 2) continue;
    const double lacks_m_s = ground.measured_at(0.0, 0.0).v_m_s - ThreePlaces::kMean_m_s - gusts[1];
    squares += lacks_m_s * lacks_m_s / (0.5 * kTicks);
  }
  if (learns) {
    EXPECT_NEAR(std::exp(estimator.reach().across_ln) / reach, 1.0, 0.25) << reach;
  }
  return squares;
}

// Gusts that reach farther show it: the wind between is known better. Where they reach less far little is known of it
// either way.
TEST(GustReachFit, TheWindBetweenTwoSensorsIsNearerToTheRealOne) {
  EXPECT_LT(error_between(2.5, true), 0.92 * error_between(2.5, false));
  EXPECT_LT(error_between(0.4, true), 1.02 * error_between(0.4, false));
}

}  // namespace
}  // namespace yuragi::wind::blend
