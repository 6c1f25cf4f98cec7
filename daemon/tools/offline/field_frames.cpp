#include "daemon/tools/offline/field_frames.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "daemon/sensing/recorded_source.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/tools/offline/offline_wind.hpp"

namespace yuragi::daemon::tools::offline {
namespace {

/// The least rate of the estimator's steps: its filters are designed for the daemon's rate.
constexpr double kMinTickRate_hz = 50.0;

}  // namespace

void make_spectral_frames(wind::field::SpectralWindField& field, const wind::field::Grid& grid,
                          const FieldFrames& frames, const UseField& use) {
  std::vector<float> values(static_cast<std::size_t>(field.dims()) * grid.size());
  for (std::size_t frame = 0; frame < frames.count; ++frame) {
    field.go_to(frames.time_s(frame));
    wind::field::sample_field(field, grid, values);
    use(values);
  }
}

Result<void, Failure> make_recorded_frames(const std::filesystem::path& recording,
                                           const drivers::windlog::PlaybackOptions& playback_options,
                                           const settings::Config& config, const wind::field::Grid& grid,
                                           const FieldFrames& frames, const UseField& use) {
  auto opened = drivers::windlog::Playback::open(recording, playback_options);
  if (!opened) return opened.error();
  drivers::windlog::Playback& playback = *opened;
  const std::shared_ptr<const wind::turbulence::GustNoise> noise = sensing::make_gust_noise(config);
  settings::Config of_recording = config;
  set_value(of_recording.sensors.at(0), sensing::recorded_source(recording, playback_options.sensor).value);
  wind::blend::BlendedEstimator estimator = sensing::make_estimator(of_recording, noise, grid.reach_m());
  wind::ground::WindTapes tapes;
  wind::ground::Wind ground;
  const wind::field::GroundWindField field(ground, *noise);

  // Several ticks per frame. A frame is that of the first tick at its time or after it.
  WindOptions offline;
  offline.rate_hz = frames.rate_hz * std::ceil(kMinTickRate_hz / frames.rate_hz);
  offline.rules = sensing::jury_rules_of(of_recording.sensors[0]);
  const double tick_s = 1.0 / offline.rate_hz;
  offline.until_s = frames.time_s(frames.count - 1) + tick_s;
  std::vector<float> values(static_cast<std::size_t>(field.dims()) * grid.size());
  std::size_t next = 0;
  const auto result = run_offline(playback, estimator, offline, [&](double time_s, const wind::State& state) {
    ground = written_to(tapes, {state, estimator.ground(), estimator.stroke()});
    if (next == frames.count || time_s < frames.time_s(next) - 0.01 * tick_s) return;
    wind::field::sample_field(field, grid, values);
    use(values);
    ++next;
  });
  if (!result) return result.error();
  if (next < frames.count) {
    return Failure{fmt::format("{}: ends after {:.1f} s, and {} frames from {:g} s on need {:.1f} s; ask for fewer "
                               "(--frames) or an earlier --time",
                               recording.string(), result->duration_s, frames.count, frames.first_s,
                               frames.time_s(frames.count - 1)),
                   FailureKind::kBadData};
  }
  return {};
}

}  // namespace yuragi::daemon::tools::offline
