#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "daemon/animation/animation.hpp"
#include "engine/look/camera.hpp"
#include "engine/wind/blend/blended_estimator.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/stream/pose_moment.hpp"

namespace yuragi::viewer {

/// The names of all scenes that pictures are made of: each kind alone, each species of tree, and the garden.
std::span<const std::string_view> picture_scenes();

struct Weather {
  std::string_view name;
  double speed_m_s;
};
inline constexpr std::array kWeathers{Weather{"calm", 0.0}, Weather{"breeze", 4.0}, Weather{"storm", 16.0}};

/// One of these scenes in the daemon's own wind of a mean speed, with its gusts, moved tick by tick without a clock:
/// the same moment has the same poses on every machine.
class ScenesInWind {
 public:
  ScenesInWind(std::string_view scene, double mean_speed_m_s);
  /// Those of a configuration, in its default wind.
  explicit ScenesInWind(const daemon::settings::Config& config);

  void advance(double duration_s);

  std::vector<wire::SceneModel> models() const { return animation_.describe().scenes; }
  stream::PoseMoment moment() const;

  /// The camera that the configuration has at this hour, where it stands at its middle; otherwise where the stage,
  /// which has these scenes, begins.
  meshes::CameraPlace home(const looks::Stage& stage, double aspect, double hour = 12.0) const;

 private:
  ScenesInWind(const daemon::settings::Config& config, const std::shared_ptr<const wind::turbulence::GustNoise>& gusts);

  double tick_s_;
  double wind_from_deg_;
  std::vector<look::Camera> cameras_;
  daemon::animation::Animation animation_;
  wind::blend::BlendedEstimator estimator_;
  static constexpr MonoTime kBegins{std::chrono::hours(1)};
  MonoTime now_ = kBegins;
  wind::State state_;
};

}  // namespace yuragi::viewer
