#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "drivers/decode/microphone/mic_analyser.hpp"
#include "drivers/decode/microphone/mic_estimator.hpp"

namespace yuragi::test {

/// Frames of one moment each, a sample a channel.
struct Sound {
  double rate_hz = 0.0;
  std::size_t channels = 1;
  std::vector<float> samples;

  std::size_t frames() const { return samples.size() / channels; }
  float& at(std::size_t frame, std::size_t channel) { return samples[frame * channels + channel]; }
  float at(std::size_t frame, std::size_t channel) const { return samples[frame * channels + channel]; }
};

/// A 16-bit WAV file with a plain header of 44 bytes; nothing where it is missing.
inline std::optional<Sound> read_wav16(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
  if (bytes.size() < 44) return std::nullopt;
  std::uint16_t channels = 0;
  std::uint32_t rate = 0;
  std::memcpy(&channels, bytes.data() + 22, sizeof channels);
  std::memcpy(&rate, bytes.data() + 24, sizeof rate);
  Sound sound{static_cast<double>(rate), channels, {}};
  for (std::size_t at = 44; at + 1 < bytes.size(); at += 2) {
    std::int16_t sample = 0;
    std::memcpy(&sample, bytes.data() + at, sizeof sample);
    sound.samples.push_back(static_cast<float>(sample) / 32768.0F);
  }
  sound.samples.resize(sound.frames() * sound.channels);
  return sound;
}

/// Wind noise as a microphone hears it: white noise that a filter of three poles shapes to about f^-7/3 in power
/// between 5 and 500 Hz, with this root mean square in each channel, independent of one another.
inline Sound wind_noise(double rate_hz, std::size_t channels, double seconds, double rms, std::uint64_t seed = 1) {
  Sound sound{rate_hz, channels, {}};
  const auto frames = static_cast<std::size_t>(rate_hz * seconds);
  sound.samples.resize(frames * channels);
  for (std::size_t channel = 0; channel < channels; ++channel) {
    std::mt19937_64 random(seed * 16 + channel);
    std::normal_distribution<double> normal;
    // A pole at 5 Hz makes f^-2; a pole at 60 Hz with a zero at 180 Hz makes it a little steeper in between.
    const auto pole = [&](double hz) { return std::exp(-2.0 * std::numbers::pi * hz / rate_hz); };
    const double slow = pole(5.0);
    const double fast = pole(60.0);
    const double zero = pole(180.0);
    double a = 0.0;
    double b = 0.0;
    double last_a = 0.0;
    double squares = 0.0;
    const auto settle = static_cast<std::size_t>(rate_hz);
    for (std::size_t i = 0; i < frames + settle; ++i) {
      a = slow * a + normal(random);
      b = fast * b + a - zero * last_a;
      last_a = a;
      if (i < settle) continue;
      sound.at(i - settle, channel) = static_cast<float>(b);
      squares += b * b;
    }
    const double scale = rms / std::sqrt(squares / static_cast<double>(frames));
    for (std::size_t i = 0; i < frames; ++i) {
      sound.at(i, channel) = static_cast<float>(scale * static_cast<double>(sound.at(i, channel)));
    }
  }
  return sound;
}

/// A voice: a pulse train that glides about 120 Hz, in syllables of a quarter of a second, with pauses. Unit rms.
inline std::vector<double> voice(double rate_hz, std::size_t frames) {
  std::vector<double> samples(frames);
  double phase = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < frames; ++i) {
    const double time_s = static_cast<double>(i) / rate_hz;
    const double pitch_hz = 120.0 + 25.0 * std::sin(2.0 * std::numbers::pi * 0.7 * time_s);
    phase += 2.0 * std::numbers::pi * pitch_hz / rate_hz;
    double pulse = 0.0;
    for (int harmonic = 1; harmonic * pitch_hz < 0.45 * rate_hz && harmonic <= 12; ++harmonic) {
      pulse += std::cos(harmonic * phase) / harmonic;
    }
    const double syllable = std::max(0.0, std::sin(2.0 * std::numbers::pi * 2.0 * time_s));
    const double phrase = std::fmod(time_s, 5.0) < 3.5 ? 1.0 : 0.0;
    samples[i] = pulse * syllable * phrase;
    squares += samples[i] * samples[i];
  }
  for (double& sample : samples) sample /= std::sqrt(squares / static_cast<double>(frames));
  return samples;
}

/// Music: a bass that walks, and a chord of three that changes every two seconds. Unit rms.
inline std::vector<double> music(double rate_hz, std::size_t frames) {
  constexpr std::array<double, 4> kRoots_hz = {41.2, 55.0, 49.0, 36.7};
  std::vector<double> samples(frames);
  double squares = 0.0;
  for (std::size_t i = 0; i < frames; ++i) {
    const double time_s = static_cast<double>(i) / rate_hz;
    const double root_hz = kRoots_hz[static_cast<std::size_t>(time_s / 2.0) % kRoots_hz.size()];
    const double beat = std::exp(-3.0 * std::fmod(time_s, 0.5));
    for (const double part : {1.0, 1.25, 1.5, 2.0}) {
      samples[i] += (part == 1.0 ? 2.0 * beat : 1.0) * std::sin(2.0 * std::numbers::pi * root_hz * part * time_s);
    }
    squares += samples[i] * samples[i];
  }
  for (double& sample : samples) sample /= std::sqrt(squares / static_cast<double>(frames));
  return samples;
}

/// The blocks of a sound, as the worker would make them.
inline std::pair<drivers::decode::microphone::MicHello, std::vector<drivers::decode::microphone::MicBlock>> blocks_of(
    const Sound& sound, double low_hz = 20.0, double high_hz = 200.0) {
  drivers::decode::microphone::MicAnalyser analyser(
      {.rate_hz = sound.rate_hz, .channels = sound.channels, .low_hz = low_hz, .high_hz = high_hz});
  std::vector<drivers::decode::microphone::MicBlock> blocks;
  for (std::size_t i = 0; i < sound.frames(); ++i) {
    const auto block = analyser.add(std::span(sound.samples).subspan(i * sound.channels, sound.channels));
    if (block) blocks.push_back(*block);
  }
  return {analyser.hello(), blocks};
}

}  // namespace yuragi::test
