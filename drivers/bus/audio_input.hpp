#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// An input of the machine's sound system.
struct AudioDevice {
  std::string name;
  std::string host_api;  ///< "ALSA", "JACK Audio Connection Kit"
  std::size_t channels = 0;
  double rate_hz = 0.0;  ///< what it prefers
  bool is_default = false;
};

struct AudioChoice {
  std::string device{};      ///< a part of the name, in any case; empty: the default input
  std::string host_api{};    ///< likewise; empty: any
  std::size_t channels = 1;  ///< 1 to kAudioMaxChannels
  double rate_hz = 0.0;      ///< 0: the device's preferred rate
};

inline constexpr std::size_t kAudioMaxChannels = 4;
inline constexpr std::size_t kAudioBlockFrames = 128;

/// A block of samples, as the sound system delivered it.
struct AudioBlock {
  std::int64_t end_mono_ns = 0;   ///< when its last frame was at the microphone, by the sound system's time stamp
  std::uint64_t end_frame = 0;    ///< frames since the stream began, including lost ones
  std::uint32_t lost_frames = 0;  ///< just before it
  std::uint32_t frames = 0;
  std::array<float, kAudioBlockFrames * kAudioMaxChannels> samples{};  ///< frame after frame
};

/// The one sound input of a process. A test may put another in its place. Thread-safe: no.
class AudioInput {
 public:
  virtual ~AudioInput() = default;

  /// The devices that were there at the first call: PortAudio's list is frozen from then on.
  virtual Result<std::vector<AudioDevice>, Failure> list() = 0;

  /// Opens and starts; returns the opened device. `now` is the clock, called on the sound system's thread:
  /// realtime-safe. The failure's text: what is missing and what there is instead.
  virtual Result<AudioDevice, Failure> open(const AudioChoice& choice, std::function<MonoTime()> now) = 0;

  /// Takes the next piece. Returns false if there is none yet.
  virtual bool take(AudioBlock& block) = 0;

  /// Returns false if the stream has ended by itself. True is no proof: the stream of a disconnected device may never
  /// report it.
  virtual bool is_running() = 0;
};

/// The real one, by PortAudio (19).
std::unique_ptr<AudioInput> make_portaudio_input();

}  // namespace yuragi::drivers::bus
