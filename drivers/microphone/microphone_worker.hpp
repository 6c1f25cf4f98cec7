#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "drivers/bus/audio_input.hpp"
#include "drivers/sensor/clock.hpp"

namespace yuragi::drivers::microphone {

/// The options of a microphone's worker process.
struct MicWorkerOptions {
  bus::AudioChoice choice{};
  double low_hz = 20.0;  ///< the wind's band
  double high_hz = 200.0;
};

/// The work of `yuragi mic-worker`: records the microphone, analyses the sound and writes frames
/// (drivers/decode/microphone/mic_frame.hpp) to `output`, until the reader closes it, the device stops, or `is_over`.
/// After an error it ends soon and reports why: restarting the process is the only reliable recovery of PortAudio.
///
/// Blocks. Returns true if it was stopped, false if the microphone failed (a trouble frame has the reason). The caller
/// then ends the process without destroying `input`, whose library may hang.
bool run_microphone_worker(const MicWorkerOptions& options, bus::AudioInput& input, const sensor::Clock& clock,
                           int output, const std::atomic<bool>& is_over);

/// The inputs of this machine, a line each: host API, channels, preferred rate in Hz, "default" or "-", and name, with
/// tabs between. What find_microphones() reads.
std::string list_of_microphones(const std::vector<bus::AudioDevice>& devices);

}  // namespace yuragi::drivers::microphone
