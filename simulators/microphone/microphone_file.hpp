#pragma once

#include <cstdint>
#include <string>

#include "simulators/core/simulator.hpp"
#include "simulators/microphone/microphone_sound.hpp"

namespace yuragi::simulators::microphone {

enum class SampleFormat : std::uint8_t { kFloat32, kSigned16 };

/// Writes `duration_s` of sound, as fast as it can be made, to `path`: a WAV file if its name ends so, or else raw
/// samples, little-endian; "-" is standard output. The reader of a pipe sets the pace, and can close it to end the
/// writing. Throws std::runtime_error if the file cannot be written.
void write_microphone_file(const std::string& path, SampleFormat format, const Options& options,
                           core::MeasuredWind wind, const core::Faults& faults, double duration_s);

}  // namespace yuragi::simulators::microphone
