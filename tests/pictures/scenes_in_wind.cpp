#include "tests/pictures/scenes_in_wind.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "daemon/sensing/sensor_hub.hpp"
#include "tests/support/places.hpp"
#include "viewer/picture/camera_place.hpp"

namespace yuragi::viewer {
namespace {

constexpr std::array<std::string_view, 11> kScenes{"grass",   "fur",    "flag",   "banner", "curtain", "cherry",
                                                   "zelkova", "poplar", "ripple", "flame",  "garden"};
constexpr double kWindFrom_deg = 250.0;

daemon::settings::Config config_of(std::string_view scene, double mean_speed_m_s) {
  const auto read = [&] {
    if (scene == "garden") return daemon::settings::load_config(test::source_path("config/garden.toml"));
    // Reeds, and gusts that touch the water, are moved by the streamed ground.
    if (scene == "ripple") {
      return daemon::settings::parse_config("[[scene]]\nkind = \"ripple\"\n[[scene]]\nkind = \"ground\"\n", "water");
    }
    const bool is_tree = scene == "cherry" || scene == "zelkova" || scene == "poplar";
    const std::string table = is_tree ? "[[scene]]\nkind = \"tree\"\nspecies = \"" + std::string(scene) + "\"\n"
                                      : "[[scene]]\nkind = \"" + std::string(scene) + "\"\n";
    return daemon::settings::parse_config(table, "a picture's configuration");
  };
  daemon::settings::Config config = read();
  config.wind.default_speed_m_s = mean_speed_m_s;
  config.wind.default_direction_deg = kWindFrom_deg;
  return config;
}

}  // namespace

std::span<const std::string_view> picture_scenes() {
  return kScenes;
}

ScenesInWind::ScenesInWind(std::string_view scene, double mean_speed_m_s)
    : ScenesInWind(config_of(scene, mean_speed_m_s)) {}

ScenesInWind::ScenesInWind(const daemon::settings::Config& config)
    : ScenesInWind(config, daemon::sensing::make_gust_noise(config)) {}

ScenesInWind::ScenesInWind(const daemon::settings::Config& config,
                           const std::shared_ptr<const wind::turbulence::GustNoise>& gusts)
    : tick_s_(1.0 / config.animation.rate_hz),
      wind_from_deg_(config.wind.default_direction_deg),
      animation_(config, gusts),
      estimator_(daemon::sensing::make_estimator(config, gusts, animation_.reach_m())) {
  for (const daemon::settings::CameraConfig& camera : config.cameras) cameras_.push_back(camera.camera);
}

void ScenesInWind::advance(double duration_s) {
  for (auto ticks = std::lround(duration_s / tick_s_); ticks > 0; --ticks) {
    now_ += from_seconds(tick_s_);
    state_ = estimator_.advance(now_);  // no sensor speaks: the configuration's default wind
    animation_.step({state_, estimator_.ground(), estimator_.stroke()}, tick_s_);
  }
}

meshes::CameraPlace ScenesInWind::home(const looks::Stage& stage, double aspect, double hour) const {
  if (cameras_.empty()) return stage.home(aspect, wind_from_deg_);
  const look::Camera& camera = cameras_[look::camera_at(cameras_, hour)];
  return picture::place_of(camera, stage.bounds_of(camera.scene), aspect, 0.0);
}

stream::PoseMoment ScenesInWind::moment() const {
  stream::PoseMoment moment;
  moment.time_s = seconds(now_ - kBegins);
  moment.wind = state_;
  for (const pose::Pose* pose : animation_.poses()) moment.poses.push_back(*pose);
  moment.opacities.assign(animation_.opacities().begin(), animation_.opacities().end());
  return moment;
}

}  // namespace yuragi::viewer
