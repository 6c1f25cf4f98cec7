#include "engine/operators/oscillator_job.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

constexpr double kOscillatorTick_s = 1.0 / 60.0;

/// Drives `count` oscillators with what `g(tick, i)` says; returns the outputs' east parts, tick after tick.
template <class Drive>
std::vector<float> swing(OscillatorJob job, std::size_t count, int ticks, const Drive& g) {
  Oscillators oscillators(count);
  std::vector<float> all;
  for (int tick = 0; tick < ticks; ++tick) {
    std::vector<float> east(count);
    for (std::size_t i = 0; i < count; ++i) east[i] = g(tick, i);
    std::vector<float> south = east;
    job.oscillators = &oscillators;
    job.east = east;
    job.south = south;
    EXPECT_EQ(job.run(), OscillatorJob::Problem::kNone);
    EXPECT_EQ(bits_of(east), bits_of(south));
    all.insert(all.end(), east.begin(), east.end());
  }
  return all;
}

class OscillatorOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(OscillatorOnEachRow);

TEST_P(OscillatorOnEachRow, ComputesTheSameBitsAsTheBaseRow) {
  const math::RandomStream random(5, math::stream_id("oscillator"));
  const auto drive = [&random](int tick, std::size_t i) {
    return static_cast<float>(random.uniform(static_cast<std::uint64_t>(tick) * 100 + i) - 0.5);
  };
  OscillatorJob job{.step = OscillatorStep::exact(2.0, 0.2, kOscillatorTick_s), .blend = 0.7};
  job.row = kBaseSimdRow;
  const auto base = swing(job, 37, 200, drive);
  job.row = GetParam();
  EXPECT_EQ(bits_of(swing(job, 37, 200, drive)), bits_of(base));
}

TEST(OscillatorTest, ABlendOf0IsTheNoiseAloneBitForBit) {
  const OscillatorJob job{.step = OscillatorStep::exact(2.0, 0.2, kOscillatorTick_s), .blend = 0.0};
  const std::vector<float> odd = {0.0F, -0.0F, 1e-42F, -1.5F, 3e38F};
  const auto out = swing(job, odd.size(), 3, [&odd](int, std::size_t i) { return odd[i]; });
  for (std::size_t i = 0; i < out.size(); ++i) EXPECT_EQ(bits_of({&out[i], 1}), bits_of({&odd[i % 5], 1}));
}

TEST(OscillatorTest, AnswersAStepAsTheClosedFormDoesWhateverTheTick) {
  const double natural_hz = 1.5;
  const double zeta = 0.15;
  const double w = 2.0 * std::numbers::pi * natural_hz;
  const double wd = w * std::sqrt(1.0 - zeta * zeta);
  for (const int rate_hz : {10, 60, 1000}) {
    const double dt_s = 1.0 / rate_hz;
    const OscillatorJob job{.step = OscillatorStep::exact(natural_hz, zeta, dt_s)};
    const auto q = swing(job, 1, 3 * rate_hz, [](int, std::size_t) { return 1.0F; });
    for (std::size_t tick = 0; tick < q.size(); ++tick) {
      const double t_s = static_cast<double>(tick + 1) * dt_s;
      const double exact = 1.0 - std::exp(-zeta * w * t_s) * (std::cos(wd * t_s) + zeta * w / wd * std::sin(wd * t_s));
      EXPECT_NEAR(q[tick], exact, 2e-5) << rate_hz << " Hz, tick " << tick;
    }
  }
}

TEST(OscillatorTest, ItsVarianceIsTheIntegralOfItsResponseTimesTheSpectrum) {
  // White noise held for a tick: its one-sided spectrum is 2 dt sinc^2(f dt) up to far beyond the resonance.
  const double natural_hz = 2.0;
  const double zeta = 0.2;
  constexpr int kTicks = 20'000;
  constexpr std::size_t kCount = 64;
  const math::RandomStream random(9, math::stream_id("white"));
  const OscillatorJob job{.step = OscillatorStep::exact(natural_hz, zeta, kOscillatorTick_s)};
  const auto q = swing(job, kCount, kTicks, [&random](int tick, std::size_t i) {
    return static_cast<float>(random.normal_pair(static_cast<std::uint64_t>(tick) * kCount + i)[0]);
  });
  double variance = 0.0;
  for (std::size_t i = 1000 * kCount; i < q.size(); ++i)
    variance += static_cast<double>(q[i]) * static_cast<double>(q[i]);
  variance /= static_cast<double>(q.size() - 1000 * kCount);

  double integral = 0.0;
  const double df = 1e-3;
  for (int k = 0; k < 200'000; ++k) {  // to 200 Hz
    const double f = (k + 0.5) * df;
    const double r = f / natural_hz;
    const double response = 1.0 / ((1.0 - r * r) * (1.0 - r * r) + 4.0 * zeta * zeta * r * r);
    const double x = std::numbers::pi * f * kOscillatorTick_s;
    const double held = 2.0 * kOscillatorTick_s * std::sin(x) * std::sin(x) / (x * x);
    integral += response * held * df;
  }
  EXPECT_NEAR(variance / integral, 1.0, 0.05);
}

TEST(OscillatorTest, NoInputMovesItFasterThanItsBounds) {
  const double zeta = 0.2;
  const double natural_hz = 2.0;
  const OscillatorJob job{.step = OscillatorStep::exact(natural_hz, zeta, kOscillatorTick_s)};
  const double rate = OscillatorStep::largest_rate_per_s(natural_hz, zeta) * kOscillatorTick_s;
  const double gain = OscillatorStep::largest_gain(zeta);

  // At resonance, as a square wave, an input within 1 comes near the bound for the rate.
  const int half_period = 15;
  const auto at_resonance =
      swing(job, 1, 1200, [](int tick, std::size_t) { return tick / half_period % 2 == 0 ? 1.0F : -1.0F; });
  double largest = 0.0;
  for (std::size_t i = 1; i < at_resonance.size(); ++i) {
    largest = std::max(largest, static_cast<double>(std::abs(at_resonance[i] - at_resonance[i - 1])));
  }
  EXPECT_LE(largest, rate);
  EXPECT_GT(largest, 0.7 * rate);

  // A triangle of slope 0.01 a tick, at resonance: near the bound for the gain.
  const auto triangle = swing(job, 1, 1200, [](int tick, std::size_t) {
    const int phase = tick % (2 * half_period);
    return 0.01F * static_cast<float>(phase < half_period ? phase : 2 * half_period - phase);
  });
  largest = 0.0;
  for (std::size_t i = 1; i < triangle.size(); ++i) {
    largest = std::max(largest, static_cast<double>(std::abs(triangle[i] - triangle[i - 1])));
  }
  EXPECT_LE(largest, gain * 0.01);
  EXPECT_GT(largest, 0.7 * gain * 0.01);
}

TEST(OscillatorTest, ComesToRestInCalm) {
  const OscillatorJob job{.step = OscillatorStep::exact(2.0, 0.2, kOscillatorTick_s)};
  const auto q = swing(job, 1, 2000, [](int tick, std::size_t) { return tick < 60 ? 1.0F : 0.0F; });
  EXPECT_NE(q[100], 0.0F);
  EXPECT_EQ(q.back(), 0.0F);
}

/// Many that each have a pace of their own.
OscillatorSteps paces(std::size_t count) {
  OscillatorSteps steps(count);
  for (std::size_t i = 0; i < count; ++i) {
    steps.set(i, OscillatorStep::exact(0.5 + 0.1 * static_cast<double>(i), 0.1, kOscillatorTick_s));
  }
  return steps;
}

TEST(OscillatorTest, EachAtItsOwnPaceGoesAsItWouldAlone) {
  constexpr std::size_t kCount = 21;
  const auto drive = [](int tick, std::size_t i) { return tick < 90 ? 0.1F * static_cast<float>(i + 1) : 0.0F; };
  const OscillatorSteps steps = paces(kCount);
  const auto all = swing({.steps = &steps}, kCount, 240, drive);
  for (std::size_t i = 0; i < kCount; ++i) {
    const OscillatorJob alone{.step =
                                  OscillatorStep::exact(0.5 + 0.1 * static_cast<double>(i), 0.1, kOscillatorTick_s)};
    const auto one = swing(alone, 1, 240, [&drive, i](int tick, std::size_t) { return drive(tick, i); });
    for (std::size_t tick = 0; tick < one.size(); ++tick) ASSERT_EQ(all[tick * kCount + i], one[tick]) << i;
  }
}

TEST_P(OscillatorOnEachRow, EachAtItsOwnPaceComputesTheSameBitsAsTheBaseRow) {
  const auto drive = [](int tick, std::size_t i) { return tick % 17 < 8 ? 0.3F : -0.01F * static_cast<float>(i); };
  const OscillatorSteps steps = paces(37);
  OscillatorJob job{.steps = &steps, .blend = 0.7};
  job.row = kBaseSimdRow;
  const auto base = swing(job, 37, 200, drive);
  job.row = GetParam();
  EXPECT_EQ(bits_of(swing(job, 37, 200, drive)), bits_of(base));
}

TEST(OscillatorTest, SaysWhatIsWrongAndThenDoesNothing) {
  Oscillators oscillators(3);
  std::vector<float> east(3, 1.0F);
  std::vector<float> south(3, 1.0F);
  const OscillatorJob good{.step = OscillatorStep::exact(2.0, 0.2, kOscillatorTick_s),
                           .oscillators = &oscillators,
                           .east = east,
                           .south = south};
  EXPECT_EQ(good.validate(), OscillatorJob::Problem::kNone);
  OscillatorJob job = good;
  job.oscillators = nullptr;
  EXPECT_EQ(job.run(), OscillatorJob::Problem::kNoOscillators);
  job = good;
  job.step.v_from_e = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(job.run(), OscillatorJob::Problem::kStepNotFinite);
  for (const double blend : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    job = good;
    job.blend = blend;
    EXPECT_EQ(job.run(), OscillatorJob::Problem::kBlend);
  }
  job = good;
  job.south = job.south.first(2);
  EXPECT_EQ(job.run(), OscillatorJob::Problem::kSizesDiffer);
  Oscillators too_few(2);
  job = good;
  job.oscillators = &too_few;
  EXPECT_EQ(job.run(), OscillatorJob::Problem::kSizesDiffer);
  const OscillatorSteps too_few_steps(2);
  job = good;
  job.steps = &too_few_steps;
  EXPECT_EQ(job.run(), OscillatorJob::Problem::kSizesDiffer);
  job = good;
  job.first = 1;
  EXPECT_EQ(job.run(), OscillatorJob::Problem::kSizesDiffer);
  job.first = 5;
  EXPECT_EQ(job.run(), OscillatorJob::Problem::kSizesDiffer);
  EXPECT_EQ(east, std::vector<float>(3, 1.0F));
}

}  // namespace
}  // namespace yuragi::operators
