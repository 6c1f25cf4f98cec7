#include "simulators/microphone/microphone_sound.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/noise/spectral_noise.hpp"
#include "engine/noise/von_karman_corner.hpp"

namespace yuragi::simulators::microphone {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kReference_m_s = 10.0;
constexpr double kPressureSlope = 7.0 / 3.0;
constexpr double kCorner_hz = 5.0;
constexpr double kTile_s = 16.0;  // after which the noise repeats; inaudible, since the wind on top does not repeat
/// The share by which a microphone that faces the wind receives more wind than the mean of all, and one in the lee
/// less.
constexpr double kFaceEffect = 0.35;

double amplitude_of(double level_db) {
  return std::pow(10.0, level_db / 20.0);
}

noise::Tile1 make_wind_noise(double rate_hz, std::uint64_t seed) {
  noise::Spec spec;
  spec.size = 1024;
  while (static_cast<double>(spec.size) < kTile_s * rate_hz && spec.size < noise::kMaxNoiseSize1) spec.size *= 2;
  spec.beta = kPressureSlope;
  spec.seed = seed;
  const double corner_cycles = kCorner_hz * static_cast<double>(spec.size) / rate_hz;
  spec.integral_scale = 1.0 / (kTurn * noise::kVonKarmanCorner * corner_cycles);
  return *noise::make_noise_1d(spec);
}

}  // namespace

Sound::Sound(const Options& options) : options_(options), random_(options.seed) {
  if (options.channels < 1 || options.channels > kMicrophoneMaxChannels || !(options.rate_hz >= 100.0)) {
    throw std::invalid_argument("a simulated microphone has 1 to 4 channels and at least 100 Hz");
  }
  for (std::size_t channel = 0; channel < options.channels; ++channel) {
    wind_.push_back(make_wind_noise(options.rate_hz, options.seed * kMicrophoneMaxChannels + channel));
  }
}

Sound::Amplitudes Sound::amplitudes_of(const core::PlayedMoment& moment) const {
  Amplitudes amplitudes{};
  for (std::size_t channel = 0; channel < options_.channels; ++channel) {
    double speed_m_s = moment.speed_m_s;
    if (options_.has_faces) {
      const double face_deg = 360.0 * static_cast<double>(channel) / static_cast<double>(options_.channels);
      speed_m_s *= 1.0 + kFaceEffect * std::cos((face_deg - moment.direction_deg) / 360.0 * kTurn);
    }
    amplitudes[channel] =
        amplitude_of(options_.level_at_10_m_s_db) * std::pow(speed_m_s / kReference_m_s, options_.exponent);
  }
  return amplitudes;
}

/// Vowels of a low voice in syllables of a quarter of a second, three and a half seconds of every five.
double Sound::voice_at(double time_s) {
  constexpr int kHarmonics = 10;
  constexpr double kVoiceScale = 1.45;  // scales to a root mean square of about 1
  const double pitch_hz = 120.0 + 25.0 * std::sin(kTurn * 0.7 * time_s);
  voice_phase_ = std::fmod(voice_phase_ + pitch_hz / options_.rate_hz, 1.0);
  if (std::fmod(time_s, 5.0) > 3.5) return 0.0;
  double pulse = 0.0;
  for (int harmonic = 1; harmonic <= kHarmonics && harmonic * pitch_hz < 0.45 * options_.rate_hz; ++harmonic) {
    pulse += std::cos(kTurn * harmonic * voice_phase_) / harmonic;
  }
  return kVoiceScale * pulse * std::max(0.0, std::sin(kTurn * 2.0 * time_s));
}

/// A chord of three notes over a bass; it changes every two seconds.
double Sound::music_at(double time_s) const {
  constexpr std::array kRoots_hz = {41.2, 55.0, 49.0, 36.7};
  constexpr std::array kParts = {1.0, 1.25, 1.5, 2.0};
  const double root_hz = kRoots_hz[static_cast<std::size_t>(time_s / 2.0) % kRoots_hz.size()];
  double sum = 0.0;
  for (const double part : kParts) sum += std::sin(kTurn * root_hz * part * time_s);
  return sum / std::sqrt(0.5 * kParts.size());
}

void Sound::render(const core::PlayedMoment& moment, std::size_t frames, std::optional<core::FaultKind> fault,
                   std::vector<float>& out) {
  const std::size_t channels = options_.channels;
  const auto second = static_cast<std::size_t>(options_.rate_hz);
  if (fault == core::FaultKind::kFreeze && !last_second_.empty()) {
    const std::size_t kept = last_second_.size() / channels;
    for (std::size_t i = 0; i < frames; ++i, ++replayed_) {
      const auto from = last_second_.begin() + static_cast<std::ptrdiff_t>(replayed_ % kept * channels);
      out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(channels));
    }
    return;
  }
  std::uniform_real_distribution<float> full_scale(-1.0F, 1.0F);
  if (fault == core::FaultKind::kGarbage) {
    for (std::size_t i = 0; i < frames * channels; ++i) out.push_back(full_scale(random_));
    return;
  }

  const Amplitudes target = amplitudes_of(moment);
  std::normal_distribution<double> normal;
  const double noise = amplitude_of(options_.noise_db);
  const double voice = options_.voice_db ? amplitude_of(*options_.voice_db) : 0.0;
  const double music = options_.music_db ? amplitude_of(*options_.music_db) : 0.0;
  for (std::size_t i = 0; i < frames; ++i, ++frame_) {
    const double time_s = static_cast<double>(frame_) / options_.rate_hz;
    const double ambient =
        (voice > 0.0 ? voice * voice_at(time_s) : 0.0) + (music > 0.0 ? music * music_at(time_s) : 0.0);
    const double done = static_cast<double>(i + 1) / static_cast<double>(frames);
    for (std::size_t channel = 0; channel < channels; ++channel) {
      const double amplitude = amplitudes_[channel] + done * (target[channel] - amplitudes_[channel]);
      const auto& tile = wind_[channel].values;
      const double wind = amplitude * static_cast<double>(tile[frame_ % tile.size()]);
      const auto sample = static_cast<float>(std::clamp(wind + noise * normal(random_) + ambient, -1.0, 1.0));
      out.push_back(sample);
      last_second_.resize(std::max(last_second_.size(), std::min(second, frame_ + 1) * channels));
      last_second_[frame_ % second * channels + channel] = sample;
    }
  }
  amplitudes_ = target;
}

}  // namespace yuragi::simulators::microphone
