#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "engine/noise/noise_tile.hpp"
#include "simulators/core/faults.hpp"
#include "simulators/core/played_wind.hpp"

namespace yuragi::simulators::microphone {

inline constexpr std::size_t kMicrophoneMaxChannels = 4;

/// Microphones in the wind, and how they respond to it. Levels are root mean squares in dB re full scale.
struct Options {
  std::size_t channels = 1;  ///< 1 to kMicrophoneMaxChannels
  double rate_hz = 48000.0;
  double exponent = 2.0;             ///< the root mean square grows with the wind to this power
  double level_at_10_m_s_db = -20;   ///< level of the whole wind noise, before it clips
  double noise_db = -80;             ///< level of each microphone's own white noise
  std::optional<double> voice_db{};  ///< level of a voice, the same at all microphones; nullopt: no voice
  std::optional<double> music_db{};  ///< likewise
  bool has_faces = false;  ///< the microphones face the directions 0, 360 / channels, ... and one that faces the wind
                           ///< receives more of it; otherwise all receive the same
  std::uint64_t seed = 1;
};

/// The sound at each microphone. Wind noise is computed separately for each: pressure with the spectrum f^-7/3 above 5
/// Hz (Raspet, Webster and Dillion 2006, "Framework for wind noise studies"), so that it is independent at two
/// microphones. Voices and music reach all of them alike. What exceeds full scale is clipped, as by a converter. The
/// same options give the same sound, bit for bit. Thread-safe: no.
class Sound {
 public:
  /// Throws std::invalid_argument for options out of range.
  explicit Sound(const Options& options);

  /// Adds `frames` frames to `out`, a sample a channel, while the wind changes evenly to `moment`. kFreeze repeats the
  /// last second, kGarbage is noise at full scale; faults of the wind itself are the caller's.
  void render(const core::PlayedMoment& moment, std::size_t frames, std::optional<core::FaultKind> fault,
              std::vector<float>& out);

 private:
  using Amplitudes = std::array<double, kMicrophoneMaxChannels>;

  Amplitudes amplitudes_of(const core::PlayedMoment& moment) const;
  double voice_at(double time_s);
  double music_at(double time_s) const;

  Options options_;
  std::vector<noise::Tile1> wind_;  ///< of each channel
  std::mt19937_64 random_;
  Amplitudes amplitudes_{};
  double voice_phase_ = 0.0;
  std::uint64_t frame_ = 0;
  std::vector<float> last_second_;  ///< a ring of frames
  std::uint64_t replayed_ = 0;
};

}  // namespace yuragi::simulators::microphone
