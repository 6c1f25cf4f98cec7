// The simulated sound by itself, and what the driver's decoder makes of it.
#include "simulators/microphone/microphone_sound.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "simulators/microphone/microphone_file.hpp"
#include "simulators/microphone/microphone_simulator.hpp"
#include "tests/support/descriptor.hpp"
#include "tests/support/mic_sounds.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::simulators::microphone {
namespace {

constexpr double kRate_hz = 16000.0;

/// So many seconds of a steady wind.
test::Sound sound_of(Options options, double speed_m_s, double seconds, double direction_deg = 0.0,
                     std::optional<core::FaultKind> fault = std::nullopt) {
  options.rate_hz = kRate_hz;
  Sound sound(options);
  test::Sound out{kRate_hz, options.channels, {}};
  // The first second brings the wind up, and is not kept.
  std::vector<float> ignored;
  sound.render({speed_m_s, direction_deg}, static_cast<std::size_t>(kRate_hz), std::nullopt, ignored);
  for (int i = 0; i < static_cast<int>(20.0 * seconds); ++i) {
    sound.render({speed_m_s, direction_deg}, static_cast<std::size_t>(kRate_hz / 20.0), fault, out.samples);
  }
  return out;
}

double rms_db(const test::Sound& sound, std::size_t channel = 0) {
  double squares = 0.0;
  for (std::size_t i = 0; i < sound.frames(); ++i) {
    const double sample = static_cast<double>(sound.at(i, channel));
    squares += sample * sample / static_cast<double>(sound.frames());
  }
  return 10.0 * std::log10(squares);
}

/// What the decoder takes for the level of the wind, on average.
double level_db(const test::Sound& sound, bool ignores_sound = true) {
  const auto [hello, blocks] = test::blocks_of(sound);
  drivers::decode::microphone::MicEstimator estimator({.ignores_sound = ignores_sound}, hello);
  double sum = 0.0;
  double count = 0.0;
  for (const drivers::decode::microphone::MicBlock& block : blocks) {
    const auto estimate = estimator.add(block);
    if (!estimate || !*estimate) continue;
    sum += (*estimate)->level_db;
    ++count;
  }
  return sum / count;
}

TEST(MicrophoneSoundTest, GrowsWithTheWindToItsExponent) {
  for (const double exponent : {1.3, 2.0, 3.0}) {
    const Options options{.exponent = exponent, .level_at_10_m_s_db = -40.0, .noise_db = -140.0};
    EXPECT_NEAR(rms_db(sound_of(options, 10.0, 14.0)), -40.0, 1.0);
    EXPECT_NEAR(rms_db(sound_of(options, 10.0, 4.0)) - rms_db(sound_of(options, 5.0, 4.0)),
                20.0 * exponent * std::log10(2.0), 0.01);
  }
}

TEST(MicrophoneSoundTest, FallsAsFrequencyToTheMinusSevenThirds) {
  const auto [hello, blocks] = test::blocks_of(sound_of({.noise_db = -140.0}, 10.0, 14.0), 20.0, 320.0);
  // Bands of a third of an octave hold f times the density: f^(-4/3).
  std::array<double, drivers::decode::microphone::kMicMaxBands> power{};
  for (const drivers::decode::microphone::MicBlock& block : blocks) {
    for (std::size_t band = 0; band < hello.bands; ++band) {
      power[band] += static_cast<double>(block.channels[0].power[band]) / hello.bins[band];
    }
  }
  const double octaves = std::log2(320.0 / 20.0) * (hello.bands - 1) / hello.bands;
  const double slope = std::log2(power[hello.bands - 1U] / power[0]) / octaves;
  std::printf("density falls as f^%.2f\n", slope);
  EXPECT_NEAR(slope, -7.0 / 3.0, 0.25);
}

TEST(MicrophoneSoundTest, WindIsHeardByEachAloneAndVoicesByAll) {
  const Options wind{.channels = 2, .level_at_10_m_s_db = -30.0};
  Options noisy = wind;
  noisy.voice_db = -40.0;
  noisy.music_db = -40.0;
  const double alone_db = level_db(sound_of(wind, 6.0, 14.0));
  const double with_db = level_db(sound_of(noisy, 6.0, 14.0));
  const double deaf_db = level_db(sound_of(noisy, 6.0, 14.0), false);
  std::printf("wind %.1f dB, with voice and music %.1f dB, without telling them apart %.1f dB\n", alone_db, with_db,
              deaf_db);
  EXPECT_NEAR(with_db, alone_db, 1.0);
  EXPECT_GT(deaf_db, alone_db + 2.0);
}

TEST(MicrophoneSoundTest, IsTheSameBitForBit) {
  const Options options{.channels = 3, .voice_db = -40.0, .music_db = -50.0, .has_faces = true, .seed = 9};
  EXPECT_EQ(sound_of(options, 7.0, 1.0, 33.0).samples, sound_of(options, 7.0, 1.0, 33.0).samples);
  Options other = options;
  other.seed = 10;
  EXPECT_NE(sound_of(options, 7.0, 1.0).samples, sound_of(other, 7.0, 1.0).samples);
}

TEST(MicrophoneSoundTest, TheFaceInTheWindIsTheLoudest) {
  const test::Sound sound = sound_of({.channels = 4, .has_faces = true}, 8.0, 14.0, 90.0);
  EXPECT_GT(rms_db(sound, 1), rms_db(sound, 0) + 3.0);
  EXPECT_GT(rms_db(sound, 0), rms_db(sound, 3) + 3.0);
  EXPECT_NEAR(rms_db(sound, 0), rms_db(sound, 2), 1.5);
}

TEST(MicrophoneSoundTest, SuffersFaultsAsADeviceDoes) {
  const test::Sound frozen = sound_of({}, 8.0, 3.0, 0.0, core::FaultKind::kFreeze);
  const auto second = static_cast<std::size_t>(kRate_hz);
  for (std::size_t i = 0; i < second; ++i) ASSERT_EQ(frozen.at(i, 0), frozen.at(i + second, 0));
  EXPECT_GT(rms_db(frozen), -40.0);

  EXPECT_NEAR(rms_db(sound_of({}, 8.0, 1.0, 0.0, core::FaultKind::kGarbage)), -4.77, 0.2)
      << "uniform over the full scale";
  for (const float sample : sound_of({.level_at_10_m_s_db = 10.0}, 20.0, 1.0).samples)
    ASSERT_LE(std::abs(sample), 1.0F);
}

TEST(MicrophoneSoundTest, TwoKnownWindsCalibrateTheDriverForAllOthers) {
  const Options options{.exponent = 1.8, .noise_db = -90.0};
  // From two points the power law follows: P = (U / gain)^(2 n).
  const double low_db = level_db(sound_of(options, 3.0, 14.0));
  const double high_db = level_db(sound_of(options, 9.0, 14.0));
  const double exponent = (high_db - low_db) / (20.0 * std::log10(9.0 / 3.0));
  const drivers::decode::microphone::MicPowerLaw law{.gain_m_s = 9.0 / std::pow(10.0, high_db / (20.0 * exponent)),
                                                     .exponent = exponent};
  std::printf("exponent %.3f (made with 1.8), gain %.1f m/s\n", law.exponent, law.gain_m_s);
  EXPECT_NEAR(law.exponent, 1.8, 0.05);

  for (const double speed_m_s : {1.0, 2.0, 4.5, 7.0, 11.0, 15.0}) {
    const auto [hello, blocks] = test::blocks_of(sound_of(options, speed_m_s, 14.0));
    drivers::decode::microphone::MicEstimator estimator({.calibration = law, .noise_floor_db = -150.0}, hello);
    double sum = 0.0;
    double count = 0.0;
    for (const drivers::decode::microphone::MicBlock& block : blocks) {
      const auto estimate = *estimator.add(block);
      if (!estimate) continue;
      sum += estimate->speed_m_s;
      ++count;
    }
    std::printf("%.1f m/s reads %.2f m/s\n", speed_m_s, sum / count);
    EXPECT_NEAR(sum / count, speed_m_s, 0.1 * speed_m_s);
  }
}

TEST(MicrophoneFile, IsAWavFileThatSaysWhatItHolds) {
  const test::TemporaryFolder folder;
  Options options{.channels = 2, .rate_hz = 8000.0};
  const auto wind = [] {
    return core::MeasuredWind(core::play_synthetic_wind({.mean_speed_m_s = 8.0, .turbulence_intensity = 0.0}));
  };
  core::Faults faults(microphone_faults());
  faults.add({core::FaultKind::kSilence, 1.0, 0.5});
  const std::string path = folder / "wind.wav";
  write_microphone_file(path, SampleFormat::kSigned16, options, wind(), faults, 2.0);
  EXPECT_EQ(std::filesystem::file_size(path), 44U + 2U * 2U * 16000U);
  const auto sound = test::read_wav16(path);
  ASSERT_TRUE(sound);
  EXPECT_EQ(sound->channels, 2U);
  EXPECT_EQ(sound->rate_hz, 8000.0);
  EXPECT_EQ(sound->frames(), 16000U);
  EXPECT_NE(sound->at(7000, 0), 0.0F);
  for (std::size_t i = 8000; i < 12000; ++i) ASSERT_EQ(sound->at(i, 1), 0.0F) << "a file cannot stop";
  EXPECT_NE(sound->at(15000, 1), 0.0F);

  // The same as raw floats.
  const std::string raw = folder / "wind.raw";
  write_microphone_file(raw, SampleFormat::kFloat32, options, wind(), faults, 2.0);
  EXPECT_EQ(std::filesystem::file_size(raw), 4U * 2U * 16000U);
  std::ifstream in(raw, std::ios::binary);
  float first = 0.0F;
  in.read(reinterpret_cast<char*>(&first), sizeof first);
  EXPECT_NEAR(first, sound->at(0, 0), 1e-4F);
  EXPECT_THROW(write_microphone_file("/nowhere/x.wav", SampleFormat::kFloat32, options, wind(), faults, 1.0),
               std::runtime_error);
}

/// A simulator on a socket, served by hand.
class MicrophoneSocket : public testing::Test {
 protected:
  MicrophoneSocket()
      : simulator_(
            {.channels = 2, .rate_hz = 8000.0}, {.socket = path(), .pipe = ""},
            core::MeasuredWind(core::play_synthetic_wind({.mean_speed_m_s = 8.0, .turbulence_intensity = 0.0}))) {}

  std::string path() const { return folder_ / "mic.sock"; }
  void serve(double by_s, std::optional<core::FaultKind> fault = std::nullopt) {
    time_s_ += by_s;
    std::vector<int> ready;
    for (const int descriptor : simulator_.descriptors()) {
      pollfd wait = {descriptor, POLLIN, 0};
      if (poll(&wait, 1, 0) > 0) ready.push_back(descriptor);
    }
    simulator_.serve(ready, time_s_, fault);
  }
  Descriptor connect() const {
    Descriptor client(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path().copy(address.sun_path, sizeof address.sun_path - 1);
    if (::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return {};
    return client;
  }
  /// The bytes that wait; nothing: the other side has hung up.
  static std::optional<std::size_t> take(const Descriptor& client) {
    std::size_t all = 0;
    std::array<char, 65536> block{};
    for (;;) {
      const ssize_t size = recv(client.get(), block.data(), block.size(), MSG_DONTWAIT);
      if (size == 0) return std::nullopt;
      if (size < 0) return all;
      all += static_cast<std::size_t>(size);
    }
  }

  test::TemporaryFolder folder_;
  Simulator simulator_;
  double time_s_ = 0.0;
};

TEST_F(MicrophoneSocket, GivesEveryClientWholeFramesAtTheirPace) {
  const Descriptor one = connect();
  const Descriptor two = connect();
  serve(0.02);
  std::size_t first = take(one).value();
  take(two);
  for (int i = 0; i < 50; ++i) {
    serve(0.02);
    first += take(one).value();
    take(two);
  }
  EXPECT_NEAR(static_cast<double>(first), 1.02 * 8000.0 * 2.0 * 4.0, 600.0);
  EXPECT_EQ(first % 8, 0U);
}

TEST_F(MicrophoneSocket, WhoReadsSlowlyLosesWholeFrames) {
  const Descriptor slow = connect();
  for (int i = 0; i < 1000; ++i) serve(0.05);
  std::size_t all = 0;
  for (int i = 0; i < 20; ++i) {
    all += take(slow).value();
    simulator_.serve({}, time_s_, core::FaultKind::kSilence);
  }
  EXPECT_GT(all, 30000U);
  EXPECT_LT(all, 50.0 * 8000.0 * 8.0);
  EXPECT_EQ(all % 8, 0U);
}

TEST_F(MicrophoneSocket, IsGoneWhileUnpluggedAndBackAfterwards) {
  const Descriptor client = connect();
  serve(0.1);
  EXPECT_GT(take(client).value(), 0U);

  serve(0.1, core::FaultKind::kSilence);
  EXPECT_EQ(take(client), 0U);
  serve(0.1, core::FaultKind::kDisconnect);
  EXPECT_EQ(take(client), std::nullopt);
  EXPECT_LT(connect().get(), 0) << "it refuses whoever comes";
  EXPECT_TRUE(std::filesystem::exists(path()));
  serve(0.1, core::FaultKind::kUnplug);
  EXPECT_FALSE(std::filesystem::exists(path()));

  serve(0.1);
  const Descriptor again = connect();
  ASSERT_GE(again.get(), 0);
  serve(0.1);
  EXPECT_GT(take(again).value(), 0U);
}

}  // namespace
}  // namespace yuragi::simulators::microphone
