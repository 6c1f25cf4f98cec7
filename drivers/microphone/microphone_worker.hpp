#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "drivers/bus/audio_input.hpp"
#include "drivers/sensor/clock.hpp"

namespace yuragi {

/// What the worker process of a microphone is to do.
struct MicWorkerOptions {
  AudioChoice choice{};
  double low_hz = 20.0;  ///< the wind's band
  double high_hz = 200.0;
};

/// The work of `yuragi mic-worker`: hears the microphone and says what it hears in frames
/// (drivers/decode/microphone/mic_frame.hpp) to `output`, until nobody reads them any more, the device stops, or
/// `is_over`. It gives up soon, and says why: a process that is begun anew is the one cure that PortAudio has.
///
/// Blocks. Returns true if it was told to end, false if the microphone failed (a trouble frame has said how). The
/// caller then ends the process without destroying `input`, whose library may hang.
bool run_microphone_worker(const MicWorkerOptions& options, AudioInput& input, const Clock& clock, int output,
                           const std::atomic<bool>& is_over);

/// The inputs of this machine, a line each: host API, channels, preferred rate in Hz, "default" or "-", and name, with
/// tabs between. What find_microphones() reads.
std::string list_of_microphones(const std::vector<AudioDevice>& devices);

}  // namespace yuragi
