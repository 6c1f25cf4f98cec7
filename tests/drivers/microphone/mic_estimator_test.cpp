#include "drivers/decode/microphone/mic_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/mic_sounds.hpp"

namespace yuragi::drivers::microphone {
namespace {

using test::Sound;

constexpr double kRate_hz = 16000.0;

struct Heard {
  std::vector<decode::microphone::MicEstimate> estimates;
  std::vector<decode::Refusal> refusals;

  double mean_speed_m_s() const {
    double sum = 0.0;
    for (const decode::microphone::MicEstimate& estimate : estimates) sum += estimate.speed_m_s;
    return sum / static_cast<double>(estimates.size());
  }
  double mean_level_db() const {
    double sum = 0.0;
    for (const decode::microphone::MicEstimate& estimate : estimates) sum += estimate.level_db;
    return sum / static_cast<double>(estimates.size());
  }
};

/// Through analyser and estimator.
Heard hear(const Sound& sound, const decode::microphone::MicEstimatorOptions& options = {}) {
  const auto [hello, blocks] = test::blocks_of(sound);
  decode::microphone::MicEstimator estimator(options, hello);
  Heard heard;
  for (const decode::microphone::MicBlock& block : blocks) {
    const auto estimate = estimator.add(block);
    if (!estimate) {
      heard.refusals.push_back(estimate.error());
    } else if (*estimate) {
      heard.estimates.push_back(**estimate);
    }
  }
  return heard;
}

/// A block without sound, to be filled by hand: one that is loud in the band and soft above it.
decode::microphone::MicBlock steady_block(const decode::microphone::MicHello& hello, std::uint64_t index,
                                          double band_power, double high_power = 1e-9) {
  decode::microphone::MicBlock block;
  block.end_sample = (index + 1) * static_cast<std::uint64_t>(0.25 * hello.rate_hz);
  block.segments = 4;
  for (std::size_t channel = 0; channel < hello.channels; ++channel) {
    for (std::size_t band = 0; band < hello.bands; ++band) {
      block.channels[channel].power[band] = static_cast<float>(band_power / hello.bands);
    }
    block.channels[channel].high_power = static_cast<float>(high_power);
    block.channels[channel].total_power = static_cast<float>(band_power + high_power);
    block.channels[channel].peak = 0.5F;
  }
  return block;
}

decode::microphone::MicHello hello_of(std::size_t channels) {
  return decode::microphone::MicAnalyser({.rate_hz = kRate_hz, .channels = channels}).hello();
}

TEST(MicEstimatorTest, AKnownLevelIsAKnownSpeedForEveryExponent) {
  const decode::microphone::MicHello hello = hello_of(1);
  for (const double exponent : {1.3, 2.0, 3.2}) {
    const decode::microphone::MicPowerLaw law{20.0, exponent};
    for (const double speed_m_s : {1.0, 4.0, 10.0}) {
      decode::microphone::MicEstimator estimator({.calibration = law, .noise_floor_db = -120.0}, hello);
      const double power = std::pow(speed_m_s / law.gain_m_s, 2.0 * exponent);
      std::optional<decode::microphone::MicEstimate> last;
      for (std::uint64_t i = 0; i < 20; ++i) last = *estimator.add(steady_block(hello, i, power));
      ASSERT_TRUE(last);
      EXPECT_NEAR(last->speed_m_s, speed_m_s, 1e-3 * speed_m_s);
      EXPECT_NEAR(last->level_db, 10.0 * std::log10(power), 1e-3);
      ASSERT_TRUE(last->gust_m_s);
      EXPECT_NEAR(*last->gust_m_s, speed_m_s, 1e-3 * speed_m_s);
      EXPECT_FALSE(last->direction_deg);
    }
  }
}

TEST(MicEstimatorTest, SaysNothingBeforeItHasHeardAWindow) {
  const decode::microphone::MicHello hello = hello_of(1);
  decode::microphone::MicEstimator estimator({}, hello);
  for (std::uint64_t i = 0; i < 3; ++i) EXPECT_FALSE(estimator.add(steady_block(hello, i, 1e-3))->has_value());
  EXPECT_TRUE(estimator.add(steady_block(hello, 3, 1e-3))->has_value());
  estimator.restart();
  EXPECT_FALSE(estimator.add(steady_block(hello, 4, 1e-3))->has_value());
}

TEST(MicEstimatorTest, AGustIsTheStrongestThreeSecondsOfTenMinutes) {
  const decode::microphone::MicHello hello = hello_of(1);
  const decode::microphone::MicPowerLaw law{20.0, 2.0};
  decode::microphone::MicEstimator estimator({.calibration = law, .noise_floor_db = -120.0}, hello);
  const auto power = [&](double speed_m_s) { return std::pow(speed_m_s / law.gain_m_s, 4.0); };
  std::optional<decode::microphone::MicEstimate> last;
  // 3 m/s, a gust of 9 m/s for five seconds in the second minute, 3 m/s again.
  for (std::uint64_t i = 0; i < 3120; ++i) {
    const double time_s = 0.25 * static_cast<double>(i);
    const bool blows = time_s >= 100.0 && time_s < 105.0;
    last = *estimator.add(steady_block(hello, i, power(blows ? 9.0 : 3.0)));
    if (!last || !last->gust_m_s) continue;
    if (time_s < 99.0) {
      EXPECT_NEAR(*last->gust_m_s, 3.0, 0.01);
    }
    if (time_s > 106.0 && time_s < 700.0) {
      EXPECT_NEAR(*last->gust_m_s, 9.0, 0.1);
    }
  }
  EXPECT_NEAR(*last->gust_m_s, 3.0, 0.01) << "forgotten after ten minutes";
}

TEST(MicEstimatorTest, FindsTheNoiseOfACalmAndTakesItOff) {
  // A minute of calm at -60 dB in the band, a minute of wind 3 dB above that, and again.
  const decode::microphone::MicHello hello = hello_of(1);
  const decode::microphone::MicPowerLaw law{20.0, 2.0};
  decode::microphone::MicEstimator estimator({.calibration = law, .noise_memory_s = 600.0}, hello);
  const double noise_power = 1e-6;
  std::mt19937_64 random(1);
  std::normal_distribution<double> scatter(0.0, 0.5);
  double calm_m_s = 0.0;
  double wind_m_s = 0.0;
  int calms = 0;
  int winds = 0;
  for (std::uint64_t i = 0; i < 2400; ++i) {
    const bool blows = i / 240 % 2 == 1;
    const double power = noise_power * (blows ? 2.0 : 1.0) * std::pow(10.0, scatter(random) / 10.0);
    const auto estimate = *estimator.add(steady_block(hello, i, power));
    if (!estimate || i < 1280) continue;
    EXPECT_NEAR(estimate->floor_db, -60.0, 1.0);
    (blows ? wind_m_s : calm_m_s) += estimate->speed_m_s;
    ++(blows ? winds : calms);
  }
  const double true_m_s = 20.0 * std::pow(noise_power, 0.25);
  std::printf("calm reads %.3f m/s, a wind of %.3f m/s in noise as loud as itself %.3f m/s\n", calm_m_s / calms,
              true_m_s, wind_m_s / winds);
  EXPECT_NEAR(wind_m_s / winds, true_m_s, 0.1 * true_m_s);
  EXPECT_LT(calm_m_s / calms, 0.35 * true_m_s);
}

TEST(MicEstimatorTest, TakesNoWindForTheNoiseOfACalm) {
  // An hour of a wind of 10 % turbulence from the first moment on: what the quietest moments have is wind.
  const decode::microphone::MicHello hello = hello_of(1);
  const decode::microphone::MicPowerLaw law{20.0, 2.0};
  decode::microphone::MicEstimator estimator({.calibration = law}, hello);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  double gust = 0.0;
  double wind_m_s = 0.0;
  double read_m_s = 0.0;
  for (std::uint64_t i = 0; i < 14000; ++i) {
    gust = 0.95 * gust + std::sqrt(1.0 - 0.95 * 0.95) * normal(random);
    const double speed_m_s = 6.0 * (1.0 + 0.1 * gust);
    const auto estimate = *estimator.add(steady_block(hello, i, std::pow(speed_m_s / law.gain_m_s, 4.0)));
    if (!estimate) continue;
    wind_m_s += speed_m_s;
    read_m_s += estimate->speed_m_s;
  }
  EXPECT_NEAR(read_m_s / wind_m_s, 1.0, 0.02);
}

TEST(MicEstimatorTest, AGivenFloorIsUsedAtOnce) {
  const decode::microphone::MicHello hello = hello_of(1);
  decode::microphone::MicEstimator estimator({.noise_floor_db = -40.0}, hello);
  std::optional<decode::microphone::MicEstimate> last;
  for (std::uint64_t i = 0; i < 4; ++i) last = *estimator.add(steady_block(hello, i, 0.9e-4));
  EXPECT_EQ(last->speed_m_s, 0.0);
  EXPECT_EQ(last->floor_db, -40.0);
}

TEST(MicEstimatorTest, ClippingRaisesTheReadingAndNeverLowersIt) {
  // The same wind, recorded louder and louder into the same converter.
  double last_m_s = 0.0;
  double unclipped_m_s = 0.0;
  for (int step = 0; step < 17; ++step) {
    const double rms = 0.02 * std::pow(1.35, step);
    Sound sound = test::wind_noise(kRate_hz, 1, 20.0, rms, 7);
    const double true_m_s = hear(sound, {.noise_floor_db = -120.0}).mean_speed_m_s();
    for (float& sample : sound.samples) sample = std::clamp(sample, -1.0F, 1.0F);
    const Heard heard = hear(sound, {.noise_floor_db = -120.0});
    const double speed_m_s = heard.mean_speed_m_s();
    const auto clipping = std::ranges::count_if(heard.estimates, &decode::microphone::MicEstimate::is_clipping);
    std::printf("rms %.2f: %5.2f m/s, without clipping %5.2f m/s, %3.0f %% of the estimates say that it clips\n", rms,
                speed_m_s, true_m_s,
                100.0 * static_cast<double>(clipping) / static_cast<double>(heard.estimates.size()));
    EXPECT_GT(speed_m_s, last_m_s) << "louder wind reads faster, clipped or not";
    EXPECT_EQ(clipping > 0, rms > 0.25) << rms;
    if (rms < 1.2) {
      EXPECT_NEAR(speed_m_s, true_m_s, 0.1 * true_m_s);
    }
    last_m_s = speed_m_s;
    if (clipping == 0) unclipped_m_s = speed_m_s;
  }
  EXPECT_GT(last_m_s, 1.5 * unclipped_m_s);
}

TEST(MicEstimatorTest, SoundThatAllHearAlikeIsNoWind) {
  const double rms = 0.03;
  const Sound wind = test::wind_noise(kRate_hz, 2, 30.0, rms);
  const double alone_m_s = hear(wind).mean_speed_m_s();
  for (const bool is_voice : {true, false}) {
    const auto ambient = is_voice ? test::voice(kRate_hz, wind.frames()) : test::music(kRate_hz, wind.frames());
    Sound mixed = wind;
    Sound calm = wind;
    for (std::size_t i = 0; i < mixed.frames(); ++i) {
      for (std::size_t channel = 0; channel < 2; ++channel) {
        mixed.at(i, channel) += static_cast<float>(rms * ambient[i]);
        calm.at(i, channel) = 0.01F * wind.at(i, channel) + static_cast<float>(rms * ambient[i]);
      }
    }
    const double with_m_s = hear(mixed).mean_speed_m_s();
    const double deaf_m_s = hear(mixed, {.ignores_sound = false}).mean_speed_m_s();
    const double only_m_s = hear(calm).mean_speed_m_s();
    const double only_deaf_m_s = hear(calm, {.ignores_sound = false}).mean_speed_m_s();
    std::printf("%s: wind %.2f m/s, with it %.2f (one microphone: %.2f); in a calm it blows %.2f (one: %.2f)\n",
                is_voice ? "voice" : "music", alone_m_s, with_m_s, deaf_m_s, only_m_s, only_deaf_m_s);
    EXPECT_NEAR(with_m_s, alone_m_s, 0.08 * alone_m_s);
    EXPECT_LT(std::abs(with_m_s - alone_m_s), std::abs(deaf_m_s - alone_m_s));
    EXPECT_LT(only_m_s, 0.5 * only_deaf_m_s);
  }
}

TEST(MicEstimatorTest, IndependentMicrophonesLoseNextToNothingToChanceCoherence) {
  for (const std::size_t channels : {2U, 3U, 4U}) {
    const Sound wind = test::wind_noise(kRate_hz, channels, 60.0, 0.1);
    const double lost_db = hear(wind, {.ignores_sound = false}).mean_level_db() - hear(wind).mean_level_db();
    std::printf("%zu microphones: %.2f dB lost\n", channels, lost_db);
    EXPECT_GE(lost_db, 0.0);
    EXPECT_LT(lost_db, 0.8);
  }
}

TEST(MicEstimatorTest, DigitalSilenceIsNoCalm) {
  Sound sound = test::wind_noise(kRate_hz, 2, 6.0, 0.1);
  for (std::size_t i = 2 * static_cast<std::size_t>(kRate_hz); i < 4 * static_cast<std::size_t>(kRate_hz); ++i) {
    sound.at(i, 0) = sound.at(i, 1) = 0.0F;
  }
  const Heard heard = hear(sound);
  EXPECT_GE(std::ranges::count(heard.refusals, decode::Refusal::kInvalid), 6);
  EXPECT_GE(heard.estimates.size(), 6U);
  for (const decode::microphone::MicEstimate& estimate : heard.estimates) EXPECT_GT(estimate.speed_m_s, 1.0);
}

/// One channel of a sound, in each of several with these gains, as samples of 16 bits.
Sound copies_of(const Sound& sound, const std::vector<float>& gains) {
  Sound copies{sound.rate_hz, gains.size(), {}};
  for (std::size_t i = 0; i < sound.frames(); ++i) {
    const float sample = std::round(sound.at(i, 0) * 32768.0F) / 32768.0F;
    for (const float gain : gains) copies.samples.push_back(gain * sample);
  }
  return copies;
}

TEST(MicEstimatorTest, OneSignalInTwoChannelsIsNoCalm) {
  const Sound wind = test::wind_noise(kRate_hz, 1, 6.0, 0.1);
  const double alone_m_s = hear(wind).mean_speed_m_s();
  EXPECT_GT(alone_m_s, 1.0);
  for (const std::vector<float>& gains : {std::vector{1.0F, 1.0F}, {1.0F, -0.7F}, {0.3F, 1.0F, 0.6F, 1.0F}}) {
    for (const double window_s : {0.25, 1.0, 3.0}) {
      const Heard heard = hear(copies_of(wind, gains), {.window_s = window_s});
      EXPECT_TRUE(heard.estimates.empty());
      EXPECT_GE(heard.refusals.size(), 1U);
      EXPECT_EQ(std::ranges::count(heard.refusals, decode::Refusal::kInvalid),
                static_cast<std::ptrdiff_t>(heard.refusals.size()));
    }
    const Heard deaf = hear(copies_of(wind, gains), {.ignores_sound = false});
    EXPECT_TRUE(deaf.refusals.empty()) << "each is as good as one microphone";
    EXPECT_GT(deaf.mean_speed_m_s(), 0.4 * alone_m_s);
  }
}

TEST(MicEstimatorTest, SaysWhichChannelsCarryTheSameSignalAndForgetsItWhenTheyDoNotAnyMore) {
  Sound sound = test::wind_noise(kRate_hz, 3, 6.0, 0.1);
  for (std::size_t i = 0; i < sound.frames() / 2; ++i) sound.at(i, 2) = 0.5F * sound.at(i, 0);
  const auto [hello, blocks] = test::blocks_of(sound);
  decode::microphone::MicEstimator estimator({}, hello);
  int refused = 0;
  int estimated = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto estimate = estimator.add(blocks[i]);
    if (!estimate) {
      EXPECT_EQ(estimator.twins(), (std::array<std::size_t, 2>{0, 2})) << i;
      EXPECT_LT(i, blocks.size() / 2 + 4);
      ++refused;
    } else if (*estimate) {
      EXPECT_FALSE(estimator.twins().has_value());
      EXPECT_GT((*estimate)->speed_m_s, 1.0);
      ++estimated;
    }
  }
  EXPECT_GE(refused, 2);
  EXPECT_GE(estimated, 4);
}

TEST(MicEstimatorTest, TwoMicrophonesInLoudSoundAreTwo) {
  const double rms = 0.1;
  for (const bool is_voice : {true, false}) {
    Sound sound = test::wind_noise(kRate_hz, 2, 30.0, 0.003 * rms);  // 50 dB below the sound
    const auto ambient = is_voice ? test::voice(kRate_hz, sound.frames()) : test::music(kRate_hz, sound.frames());
    for (std::size_t i = 0; i < sound.frames(); ++i) {
      for (std::size_t channel = 0; channel < 2; ++channel)
        sound.at(i, channel) += static_cast<float>(rms * ambient[i]);
    }
    const Heard heard = hear(sound);
    EXPECT_TRUE(heard.refusals.empty()) << heard.refusals.size();
    EXPECT_GT(heard.estimates.size(), 100U);
  }
}

TEST(MicEstimatorTest, ADeadChannelIsNamedAndTheOthersGoOn) {
  Sound sound = test::wind_noise(kRate_hz, 3, 4.0, 0.1);
  const double whole_m_s = hear(sound).mean_speed_m_s();
  for (std::size_t i = 0; i < sound.frames(); ++i) sound.at(i, 1) = 0.0F;
  const Heard heard = hear(sound);
  EXPECT_TRUE(heard.refusals.empty());
  EXPECT_EQ(heard.estimates.back().silent_channels, 2U);
  EXPECT_NEAR(heard.mean_speed_m_s(), whole_m_s, 0.1 * whole_m_s);
}

TEST(MicEstimatorTest, RefusesFullScaleNoiseAndSamplesThatAreNone) {
  Sound sound{kRate_hz, 2, {}};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> full_scale(-1.0F, 1.0F);
  for (int i = 0; i < 64000; ++i) sound.samples.push_back(full_scale(random));
  const Heard heard = hear(sound);
  EXPECT_TRUE(heard.estimates.empty());
  EXPECT_EQ(std::ranges::count(heard.refusals, decode::Refusal::kImplausible),
            static_cast<long>(heard.refusals.size()));

  Sound broken = test::wind_noise(kRate_hz, 1, 3.0, 0.1);
  for (std::size_t i = 0; i < broken.frames(); i += 100) broken.at(i, 0) = std::nanf("");
  const Heard nothing = hear(broken);
  EXPECT_TRUE(nothing.estimates.empty());
  EXPECT_GE(std::ranges::count(nothing.refusals, decode::Refusal::kInvalid), 8);
}

/// Ten minutes of levels as a gusty wind makes them, through a device with or without automatic gain.
bool is_suspected(double gain_ratio, double turbulence, bool somebody_speaks) {
  decode::microphone::MicGainWatch watch;
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  double gust = 0.0;
  for (int i = 0; i < 2400; ++i) {
    gust = 0.97 * gust + std::sqrt(1.0 - 0.97 * 0.97) * normal(random);
    const double wind_db = -30.0 + 40.0 * std::log10(std::max(0.2, 1.0 + turbulence * gust)) + 0.4 * normal(random);
    const bool speaks = somebody_speaks && i / 20 % 3 == 0;
    const double high_db = (speaks ? -45.0 : -75.0) + 0.3 * normal(random);
    const double gain_db = -gain_ratio * (wind_db + 25.0);
    watch.add(wind_db + gain_db, high_db + gain_db, 0.25);
  }
  return watch.suspects();
}

TEST(MicEstimatorTest, SuspectsAutomaticGainAndNothingElse) {
  EXPECT_FALSE(is_suspected(0.0, 0.25, false));
  EXPECT_FALSE(is_suspected(0.0, 0.1, false));
  EXPECT_FALSE(is_suspected(0.0, 0.25, true)) << "a voice is no automatic gain";
  EXPECT_TRUE(is_suspected(0.5, 0.25, false)) << "half of each decibel taken back";
  EXPECT_TRUE(is_suspected(0.7, 0.25, false));
  EXPECT_TRUE(is_suspected(1.0, 0.25, false)) << "levelled altogether";
}

/// Two minutes and more of gusts over the hiss of a cheap microphone, and a voice beside it if there is one;
/// `release_s`: through an amplifier that levels them, as those of conference microphones do, within a tenth of a
/// second down and slowly up again.
Sound gusts_through(std::optional<double> release_s, const std::vector<double>& speech = {}) {
  constexpr double kSlow_hz = 8000.0;
  Sound sound = test::wind_noise(kSlow_hz, 1, 140.0, 0.05);
  std::mt19937_64 random(3);
  std::normal_distribution<float> hiss(0.0F, 1e-3F);
  double envelope = 0.05;
  for (std::size_t i = 0; i < sound.frames(); ++i) {
    const double time_s = static_cast<double>(i) / kSlow_hz;
    const double gust = 1.0 + 0.5 * std::sin(0.4 * time_s) + 0.3 * std::sin(1.1 * time_s);
    double sample = gust * gust * static_cast<double>(sound.at(i, 0)) + static_cast<double>(hiss(random));
    if (!speech.empty()) sample += 0.03 * speech[i % speech.size()];
    if (release_s) {
      const double magnitude = std::abs(sample);
      envelope += (magnitude - envelope) / ((magnitude > envelope ? 0.1 : *release_s) * kSlow_hz);
      sample *= std::clamp(0.1 / envelope, 0.1, 20.0);
    }
    sound.at(i, 0) = static_cast<float>(sample);
  }
  return sound;
}

TEST(MicEstimatorTest, HearsAnAmplifierThatLevelsTheGusts) {
  const auto is_heard = [](const Sound& sound) { return hear(sound).estimates.back().suspects_automatic_gain; };
  EXPECT_FALSE(is_heard(gusts_through(std::nullopt)));
  EXPECT_FALSE(is_heard(gusts_through(std::nullopt, test::voice(8000.0, 160000)))) << "a voice is no automatic gain";
  for (const double release_s : {0.3, 1.0, 5.0}) EXPECT_TRUE(is_heard(gusts_through(release_s))) << release_s;
}

/// Blocks of faces that hear a wind from `direction_deg`, louder on its side.
std::vector<decode::microphone::MicEstimate> turn(const std::vector<double>& faces_deg,
                                                  const std::vector<double>& wind_from_deg, double effect,
                                                  double scatter_db = 0.3) {
  const decode::microphone::MicHello hello = hello_of(faces_deg.size());
  const decode::microphone::MicPowerLaw law{20.0, 2.0};
  decode::microphone::MicEstimator estimator({.calibration = law, .noise_floor_db = -120.0, .faces_deg = faces_deg},
                                             hello);
  std::mt19937_64 random(2);
  std::normal_distribution<double> scatter(0.0, scatter_db);
  std::vector<decode::microphone::MicEstimate> estimates;
  for (std::size_t i = 0; i < wind_from_deg.size(); ++i) {
    decode::microphone::MicBlock block = steady_block(hello, i, 1.0);
    for (std::size_t face = 0; face < faces_deg.size(); ++face) {
      const double angle = (faces_deg[face] - wind_from_deg[i]) / 180.0 * std::numbers::pi;
      const double power = std::pow(6.0 * (1.0 + effect * std::cos(angle)) / law.gain_m_s, 4.0);
      for (float& band : block.channels[face].power) {
        band *= static_cast<float>(power * std::pow(10.0, scatter(random) / 10.0));
      }
      block.channels[face].total_power = static_cast<float>(power);
    }
    const auto estimate = *estimator.add(block);
    if (estimate) estimates.push_back(*estimate);
  }
  return estimates;
}

double turned_apart_deg(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 360.0));
}

TEST(MicEstimatorTest, TellsEveryDirectionFromThreeFacesAndFromFour) {
  for (const std::vector<double>& faces_deg :
       {std::vector{0.0, 120.0, 240.0}, std::vector{0.0, 90.0, 180.0, 270.0}, std::vector{20.0, 130.0, 260.0}}) {
    double worst_deg = 0.0;
    for (int step = 0; step < 36; ++step) {
      const double direction_deg = 10.0 * step;
      const auto estimates = turn(faces_deg, std::vector<double>(120, direction_deg), 0.3);
      ASSERT_TRUE(estimates.back().direction_deg) << direction_deg;
      worst_deg = std::max(worst_deg, turned_apart_deg(*estimates.back().direction_deg, direction_deg));
      EXPECT_GT(estimates.back().direction_confidence, 0.6);
    }
    std::printf("%zu faces: off by %.1f degrees at worst\n", faces_deg.size(), worst_deg);
    EXPECT_LT(worst_deg, 6.0);
  }
}

TEST(MicEstimatorTest, GoesThroughNorthAndNotAround) {
  std::vector<double> wind_from_deg(80, 350.0);
  for (int i = 0; i < 200; ++i) wind_from_deg.push_back(10.0);
  for (const decode::microphone::MicEstimate& estimate : turn({0.0, 120.0, 240.0}, wind_from_deg, 0.3)) {
    if (!estimate.direction_deg) continue;
    EXPECT_LT(turned_apart_deg(*estimate.direction_deg, 0.0), 18.0);
  }
  // Half of the time here, half of the time there.
  wind_from_deg.clear();
  for (int i = 0; i < 400; ++i) wind_from_deg.push_back(i % 2 == 0 ? 350.0 : 10.0);
  const auto estimates = turn({0.0, 120.0, 240.0}, wind_from_deg, 0.3);
  EXPECT_LT(turned_apart_deg(*estimates.back().direction_deg, 0.0), 5.0);
}

TEST(MicEstimatorTest, HasNoDirectionWhereAllFacesHearTheSame) {
  int with = 0;
  for (const decode::microphone::MicEstimate& estimate :
       turn({0.0, 120.0, 240.0}, std::vector<double>(400, 90.0), 0.0)) {
    EXPECT_LT(estimate.direction_confidence, 0.3);
    with += estimate.direction_deg ? 1 : 0;
  }
  EXPECT_EQ(with, 0);
}

TEST(MicEstimatorTest, RefusesFacesThatAreNoDirections) {
  const decode::microphone::MicHello three = hello_of(3);
  EXPECT_THROW(decode::microphone::MicEstimator({.faces_deg = {0.0, 120.0}}, three), std::invalid_argument);
  EXPECT_THROW(decode::microphone::MicEstimator({.faces_deg = {0.0, 0.0, 180.0}}, three), std::invalid_argument);
  EXPECT_THROW(decode::microphone::MicEstimator({.faces_deg = {0.0, 5.0, 10.0}}, three), std::invalid_argument);
}

}  // namespace
}  // namespace yuragi::drivers::microphone
