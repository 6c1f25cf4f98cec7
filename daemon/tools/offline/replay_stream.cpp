#include "daemon/tools/offline/replay_stream.hpp"

#include <utility>

#include "daemon/animation/scene_list.hpp"
#include "engine/base/version.hpp"
#include "engine/look/camera.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::tools::offline {

ReplayStream::ReplayStream(const settings::Config& config, Write write) : config_(config), write_(std::move(write)) {
  for (const settings::CameraConfig& camera : config.cameras) cameras_.push_back(camera.camera);
}

void ReplayStream::write(const ReplayTick& tick) {
  if (ticks_ == 0) begin(tick);
  const std::size_t camera = look::camera_at(cameras_, config_.clock.hour_of_day(tick.recorded));
  if (camera_ != camera) write_status(tick, camera);
  write_(tick.animation.encode({.sequence = ticks_,
                                .tick = ticks_,
                                .time_s = tick.log_time_s,
                                .utc_ns = static_cast<std::int64_t>(tick.recorded.time_since_epoch().count()),
                                .wind = tick.wind}));
  ++ticks_;
}

void ReplayStream::begin(const ReplayTick& tick) {
  write_(wire::encode(wire::Hello{.software = with_version("yuragi"),
                                  .tick_rate_hz = config_.animation.rate_hz,
                                  .wind_from_deg = config_.wind.default_direction_deg}));
  write_(animation::checked_scenes_message(tick.animation.describe()));
  wire::PlayerState player;
  player.is_open = true;
  player.length_s = tick.log_time_s + tick.left_s;
  write_(wire::encode(wire::ControlReply{.done = true, .message = {}, .scenes = {}, .players = {player}}));
}

void ReplayStream::write_status(const ReplayTick& tick, std::size_t camera) {
  wire::Sensors status;
  status.wind = tick.wind;
  status.look = config_.look;
  status.cameras = cameras_;
  status.camera = camera;
  write_(wire::encode(status));
  camera_ = camera;
}

}  // namespace yuragi::daemon::tools::offline
