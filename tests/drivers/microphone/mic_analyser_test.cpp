#include "drivers/decode/microphone/mic_analyser.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "drivers/decode/microphone/sample_clock.hpp"
#include "tests/support/mic_sounds.hpp"

namespace yuragi::drivers::microphone {
namespace {

test::Sound sine(double rate_hz, std::size_t channels, double seconds, double frequency_hz, double amplitude,
                 double offset = 0.0) {
  test::Sound sound{rate_hz, channels, {}};
  const auto frames = static_cast<std::size_t>(rate_hz * seconds);
  for (std::size_t i = 0; i < frames; ++i) {
    const double phase = 2.0 * std::numbers::pi * frequency_hz * static_cast<double>(i) / rate_hz;
    for (std::size_t channel = 0; channel < channels; ++channel) {
      sound.samples.push_back(static_cast<float>(offset + amplitude * std::sin(phase)));
    }
  }
  return sound;
}

double band_power(const decode::microphone::MicHello& hello, const decode::microphone::MicChannel& channel) {
  double sum = 0.0;
  for (std::size_t band = 0; band < hello.bands; ++band) sum += static_cast<double>(channel.power[band]);
  return sum;
}

TEST(MicAnalyser, MeasuresTheMeanSquareOfASineInItsBandAtEveryRate) {
  for (const double rate_hz : {250.0, 8000.0, 16000.0, 44100.0, 48000.0, 192000.0}) {
    SCOPED_TRACE(rate_hz);
    const auto [hello, blocks] = test::blocks_of(sine(rate_hz, 1, 2.0, 60.0, 0.5));
    ASSERT_GE(blocks.size(), 5U);
    for (const decode::microphone::MicBlock& block : blocks) {
      EXPECT_NEAR(band_power(hello, block.channels[0]), 0.125, 0.006);
      EXPECT_NEAR(static_cast<double>(block.channels[0].total_power), 0.125, 0.006);
      EXPECT_NEAR(static_cast<double>(block.channels[0].peak), 0.5, 0.02);
    }
  }
}

TEST(MicAnalyser, HearsNothingOfWhatLiesOutsideTheBand) {
  for (const double frequency_hz : {3.0, 400.0, 1000.0}) {
    SCOPED_TRACE(frequency_hz);
    const auto [hello, blocks] = test::blocks_of(sine(48000.0, 1, 2.0, frequency_hz, 0.5));
    for (const decode::microphone::MicBlock& block : blocks)
      EXPECT_LT(band_power(hello, block.channels[0]), 0.125 * 1e-2);
  }
}

TEST(MicAnalyser, BlocksTheOffsetOfACheapConverter) {
  const auto [hello, blocks] = test::blocks_of(sine(48000.0, 1, 2.0, 60.0, 0.1, 0.5));
  for (const decode::microphone::MicBlock& block : blocks) {
    EXPECT_NEAR(band_power(hello, block.channels[0]), 0.005, 0.0003);
    EXPECT_NEAR(static_cast<double>(block.channels[0].peak), 0.1, 0.01);
  }
  const auto [silent_hello, silent] = test::blocks_of(sine(48000.0, 1, 1.0, 60.0, 0.0, 0.25));
  EXPECT_LT(static_cast<double>(silent.back().channels[0].peak), 1e-6) << "a constant is no sound";
}

TEST(MicAnalyser, CrossPowerOfEqualChannelsIsTheirPowerAndOfIndependentOnesSmall) {
  const auto [hello, same] = test::blocks_of(sine(16000.0, 2, 2.0, 60.0, 0.5));
  for (const decode::microphone::MicBlock& block : same) {
    for (std::size_t band = 0; band < hello.bands; ++band) {
      EXPECT_NEAR(static_cast<double>(block.cross[0][band].real()), static_cast<double>(block.channels[0].power[band]),
                  1e-6);
      EXPECT_NEAR(static_cast<double>(block.cross[0][band].imag()), 0.0, 1e-6);
    }
  }

  const auto [wind_hello, wind] = test::blocks_of(test::wind_noise(16000.0, 2, 20.0, 0.1));
  std::complex<double> cross;
  double power = 0.0;
  for (const decode::microphone::MicBlock& block : wind) {
    cross += std::complex<double>(block.cross[0][1]);
    power += static_cast<double>(block.channels[0].power[1]);
  }
  EXPECT_LT(std::abs(cross) / power, 0.25);
}

TEST(MicAnalyser, SaysFourTimesASecondHowManySamplesThereWere) {
  decode::microphone::MicAnalyser analyser({.rate_hz = 48000.0, .channels = 1});
  std::vector<std::uint64_t> ends;
  const float sample = 0.1F;
  for (std::uint64_t i = 1; i <= 480000; ++i) {
    const auto block = analyser.add(std::span(&sample, 1));
    if (!block) continue;
    EXPECT_EQ(block->end_sample, i);
    ends.push_back(i);
  }
  EXPECT_NEAR(static_cast<double>(ends.size()), 40.0, 2.0);
}

TEST(MicAnalyser, CountsWhatClipsAndWhatIsNoSound) {
  test::Sound sound = sine(16000.0, 2, 1.0, 60.0, 0.5);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  sound.at(5000, 1) = kNan;
  sound.at(5001, 1) = kInfinity;
  sound.at(5002, 1) = -1e20F;
  for (std::size_t i = 0; i < sound.frames() / 4; ++i) sound.at(4 * i, 0) = -1.0F;

  const auto [hello, blocks] = test::blocks_of(sound);
  std::uint32_t invalid = 0;
  for (const decode::microphone::MicBlock& block : blocks) {
    invalid += block.invalid_samples;
    EXPECT_NEAR(static_cast<double>(block.channels[0].clipped), 0.25, 0.01);
    EXPECT_EQ(block.channels[1].clipped, 0.0F);
    EXPECT_TRUE(std::isfinite(block.channels[1].total_power));
    EXPECT_LE(block.channels[1].peak, 0.6F);
  }
  EXPECT_EQ(invalid, 3U);
}

TEST(MicAnalyser, RefusesABandThatTheRateCannotShow) {
  EXPECT_THROW(decode::microphone::MicAnalyser({.rate_hz = 250.0, .channels = 1, .low_hz = 90.0, .high_hz = 200.0}),
               std::invalid_argument);
  EXPECT_THROW(decode::microphone::MicAnalyser({.rate_hz = 48000.0, .channels = 5}), std::invalid_argument);
  EXPECT_THROW(decode::microphone::MicAnalyser({.rate_hz = std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
}

TEST(SampleClockTest, TakesTheJitterOutAndFindsTheTrueRate) {
  // 48 kHz that is 80 ppm fast; buffers of 10 ms, each up to 8 ms late.
  const double true_ns = 1e9 / (48000.0 * 1.00008);
  decode::microphone::SampleClock clock(48000.0);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> lateness_ns(0.0, 8e6);
  double worst_ns = 0.0;
  double sum_ns = 0.0;
  int counted = 0;
  for (std::uint64_t i = 1; i <= 12000; ++i) {
    const std::uint64_t sample = 480 * i;
    const double exact_ns = 5e12 + static_cast<double>(sample) * true_ns;
    const std::int64_t smooth = clock.add(sample, std::llround(exact_ns + lateness_ns(random)));
    if (i < 6000) continue;
    const double error_ns = static_cast<double>(smooth) - exact_ns - 4e6;  // the mean lateness cannot be known
    worst_ns = std::max(worst_ns, std::abs(error_ns));
    sum_ns += error_ns;
    ++counted;
  }
  std::printf("jitter of 8 ms becomes %.2f ms at worst; rate off by %.1f ppm\n", worst_ns * 1e-6,
              1e6 * (clock.sample_ns() / true_ns - 1.0));
  EXPECT_LT(worst_ns, 1.5e6);
  EXPECT_LT(std::abs(sum_ns / counted), 0.3e6);
  EXPECT_NEAR(clock.sample_ns() / true_ns, 1.0, 60e-6);
}

TEST(SampleClockTest, BeginsAnewAfterAGap) {
  decode::microphone::SampleClock clock(48000.0);
  EXPECT_EQ(clock.add(480, 10'000'000), 10'000'000);
  EXPECT_NEAR(static_cast<double>(clock.add(960, 21'000'000)), 20.5e6, 0.6e6);
  EXPECT_EQ(clock.add(1440, 9'000'000'000), 9'000'000'000) << "suspended for nine seconds";
  EXPECT_EQ(clock.add(480, 9'500'000'000), 9'500'000'000) << "another stream";
}

}  // namespace
}  // namespace yuragi::drivers::microphone
