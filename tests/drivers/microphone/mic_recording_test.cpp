// A real recording: two microphones beside a cup anemometer in front of a fan (drivers/SOURCES.md S6). Prints its
// figures, and skips where the recording is not there.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/mic_sounds.hpp"
#include "tests/support/places.hpp"

namespace yuragi::drivers::microphone {
namespace {

using test::Sound;

constexpr double kScored_s = 5.0;

/// What a cup said beside each sample.
std::vector<double> read_cup(const std::string& path, std::size_t frames) {
  std::vector<double> speed_m_s(frames);
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::size_t start = 0, count = 0;
    double t_ms = 0.0, speed = 0.0;
    char comma = 0;
    if (!(fields >> start >> comma >> count >> comma >> t_ms >> comma >> speed)) continue;
    for (std::size_t i = start; i < std::min(frames, start + count); ++i) speed_m_s[i] = speed;
  }
  return speed_m_s;
}

/// What estimator and cup say, each as its mean over a window of 5 s.
struct Windows {
  std::vector<double> level_db, estimate_m_s, cup_m_s;
  std::size_t size() const { return cup_m_s.size(); }
};

class MicRecording : public testing::Test {
 protected:
  void SetUp() override {
    const std::string folder = "../shared/data/mic/asu_inmp441_north3_";
    auto sound = test::read_wav16(test::source_path(folder + "2ch_250hz.wav"));
    if (!sound) GTEST_SKIP() << "../shared/data/mic is not there";
    sound_ = std::move(*sound);
    cup_ = read_cup(test::source_path(folder + "labels.csv"), sound_.frames());
  }

  Windows windows_of(const Sound& sound, const decode::microphone::MicCalibration& calibration) const {
    const auto [hello, blocks] = test::blocks_of(sound);
    // The floor that a calm of this recording has is not known: none is taken off.
    decode::microphone::MicEstimator estimator({.calibration = calibration, .noise_floor_db = -200.0}, hello);
    const auto frames_per_window = static_cast<std::size_t>(kScored_s * sound.rate_hz);
    Windows windows;
    std::vector<double> count;
    for (const decode::microphone::MicBlock& block : blocks) {
      const auto estimate = estimator.add(block);
      if (!estimate || !*estimate) continue;
      const std::size_t window = (block.end_sample - 1) / frames_per_window;
      if (window >= sound.frames() / frames_per_window) break;
      if (window >= windows.size()) {
        windows.level_db.resize(window + 1);
        windows.estimate_m_s.resize(window + 1);
        windows.cup_m_s.resize(window + 1);
        count.resize(window + 1);
      }
      windows.level_db[window] += (*estimate)->level_db;
      windows.estimate_m_s[window] += (*estimate)->speed_m_s;
      ++count[window];
    }
    for (std::size_t i = 0; i < windows.size(); ++i) {
      windows.level_db[i] /= count[i];
      windows.estimate_m_s[i] /= count[i];
      const auto begin = cup_.begin() + static_cast<std::ptrdiff_t>(i * frames_per_window);
      windows.cup_m_s[i] = std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(frames_per_window), 0.0) /
                           static_cast<double>(frames_per_window);
    }
    return windows;
  }

  /// Calibrated on the windows that `taught` says, without looking at the others.
  template <class Choice>
  decode::microphone::MicFit calibrate(Choice&& taught) const {
    const Windows windows = windows_of(sound_, decode::microphone::MicPowerLaw{});
    std::vector<decode::microphone::MicLevelAndSpeed> pairs;
    for (std::size_t i = 0; i < windows.size(); ++i) {
      if (taught(i, windows.size())) pairs.push_back({windows.level_db[i], windows.cup_m_s[i]});
    }
    auto fit = decode::microphone::fit_mic_calibration(pairs);
    EXPECT_TRUE(fit) << (fit ? "" : fit.error().message);
    return *fit;
  }

  template <class Choice>
  static double mean_error_m_s(const Windows& windows, Choice&& scored) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < windows.size(); ++i) {
      if (!scored(i, windows.size())) continue;
      sum += std::abs(windows.estimate_m_s[i] - windows.cup_m_s[i]);
      ++count;
    }
    return sum / count;
  }

  Sound sound_;
  std::vector<double> cup_;
};

bool is_odd(std::size_t i, std::size_t) {
  return i % 2 == 1;
}
bool is_even(std::size_t i, std::size_t) {
  return i % 2 == 0;
}

std::string described(const decode::microphone::MicCalibration& calibration) {
  if (const auto* law = std::get_if<decode::microphone::MicPowerLaw>(&calibration)) {
    return "power law, gain " + std::to_string(law->gain_m_s) + " m/s, exponent " + std::to_string(law->exponent);
  }
  return "curve " + decode::microphone::format_mic_curve(std::get<decode::microphone::MicCurve>(calibration));
}

TEST_F(MicRecording, AgreesWithTheCupOnWindowsThatItWasNotCalibratedOn) {
  const decode::microphone::MicFit fit = calibrate(is_odd);
  const Windows windows = windows_of(sound_, fit.calibration);
  const double error_m_s = mean_error_m_s(windows, is_even);
  std::printf("calibrated on the odd windows of 5 s, scored on the even: mean absolute error %.3f m/s (%s)\n",
              error_m_s, described(fit.calibration).c_str());
  EXPECT_LE(error_m_s, 0.65);
}

TEST_F(MicRecording, GrowsFromBinToBinOfTheCup) {
  const Windows windows = windows_of(sound_, calibrate(is_odd).calibration);
  double last_m_s = -1.0;
  for (int bin = 0; bin < 8; ++bin) {
    const double low_m_s = bin;
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < windows.size(); ++i) {
      if (windows.cup_m_s[i] < low_m_s || windows.cup_m_s[i] >= low_m_s + 1.0) continue;
      sum += windows.estimate_m_s[i];
      ++count;
    }
    if (count == 0) continue;
    std::printf("cup %.0f to %.0f m/s: %2d windows, estimate %.2f m/s\n", low_m_s, low_m_s + 1.0, count, sum / count);
    EXPECT_GT(sum / count, last_m_s);
    last_m_s = sum / count;
  }
  EXPECT_GT(last_m_s, 5.0);
}

TEST_F(MicRecording, CarriesFromTheCalmHalfToTheWindyOne) {
  const auto first = [](std::size_t i, std::size_t count) { return i < count / 2; };
  const auto second = [](std::size_t i, std::size_t count) { return i >= count / 2; };
  const Windows windows = windows_of(sound_, calibrate(first).calibration);
  const double error_m_s = mean_error_m_s(windows, second);
  std::printf("calibrated on the first half, scored on the second: mean absolute error %.3f m/s\n", error_m_s);
  EXPECT_LE(error_m_s, 1.8);
}

TEST_F(MicRecording, HardlyMovesWhenSomebodySpeaksOrPlays) {
  const decode::microphone::MicCalibration calibration = calibrate(is_odd).calibration;
  const Windows before = windows_of(sound_, calibration);
  double squares = 0.0;
  for (const float sample : sound_.samples) squares += static_cast<double>(sample) * static_cast<double>(sample);
  const double rms = std::sqrt(squares / static_cast<double>(sound_.samples.size()));

  for (const bool is_voice : {true, false}) {
    const auto ambient =
        is_voice ? test::voice(sound_.rate_hz, sound_.frames()) : test::music(sound_.rate_hz, sound_.frames());
    Sound mixed = sound_;
    for (std::size_t i = 0; i < mixed.frames(); ++i) {
      for (std::size_t channel = 0; channel < mixed.channels; ++channel) {
        mixed.at(i, channel) += static_cast<float>(rms * ambient[i]);
      }
    }
    const Windows after = windows_of(mixed, calibration);
    double moved_m_s = 0.0;
    double shifted_m_s = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const double difference = after.estimate_m_s[i] - before.estimate_m_s[i];
      moved_m_s += std::abs(difference) / static_cast<double>(before.size());
      shifted_m_s += difference / static_cast<double>(before.size());
    }
    std::printf("%s at the power of the recording, on both channels: moves by %.3f m/s (shift %+.3f)\n",
                is_voice ? "a voice" : "music", moved_m_s, shifted_m_s);
    EXPECT_LT(moved_m_s, 0.5);
  }
}

}  // namespace
}  // namespace yuragi::drivers::microphone
