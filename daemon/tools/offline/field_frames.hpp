#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "daemon/settings/config.hpp"
#include "drivers/windlog/windlog_playback.hpp"
#include "engine/wind/field/spectral_wind_field.hpp"
#include "engine/wind/field/wind_field.hpp"

namespace yuragi::daemon::tools::offline {

/// The moments at which a field is sampled.
struct FieldFrames {
  double first_s = 0.0;
  std::size_t count = 1;
  double rate_hz = 10.0;

  double time_s(std::size_t frame) const { return first_s + static_cast<double>(frame) / rate_hz; }
};

/// Called with each frame in order: sample_field() at that moment. May throw.
using UseField = std::function<void(std::span<const float> values)>;

/// The frames of a wind with given statistics.
void make_spectral_frames(wind::field::SpectralWindField& field, const wind::field::Grid& grid,
                          const FieldFrames& frames, const UseField& use);

/// The frames of the live wind over the ground, as the daemon with this configuration would have estimated it while the
/// recording was made: the estimator takes its readings one by one from the beginning on. Fails if the recording
/// cannot be read, or ends before the last frame.
Result<void, Failure> make_recorded_frames(const std::filesystem::path& recording,
                                           const drivers::windlog::PlaybackOptions& playback,
                                           const settings::Config& config, const wind::field::Grid& grid,
                                           const FieldFrames& frames, const UseField& use);

}  // namespace yuragi::daemon::tools::offline
