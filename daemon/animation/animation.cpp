#include "daemon/animation/animation.hpp"

#include <algorithm>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::daemon::animation {
namespace {

/// Enough places for every sensor, and no more: a tape takes half a megabyte.
std::size_t most_pens(const settings::Config& config) {
  return std::min(wind::ground::WindStroke::kMostPens, config.sensors.size() + (config.wind.fallback ? 1 : 0));
}

}  // namespace

Animation::Animation(const settings::Config& config, const std::shared_ptr<const wind::turbulence::GustNoise>& gusts)
    : pool_(config.animation.threads), tapes_(most_pens(config)) {
  for (const settings::SceneConfig& scene : config.scenes) {
    names_.push_back(scene.name);
    kinds_.emplace_back(scene.kind->name);
    scenes_.push_back(scene.kind->make(
        scene.values, {.seed = config.seed + scenes_.size(), .placement = scene.placement, .gusts = gusts}));
    gains_.push_back(scene.wind_gain);
    fades_.emplace_back(scene.is_shown);
    skeletons_.push_back(&scenes_.back()->skeleton());
    poses_.push_back(&scenes_.back()->pose());
    opacities_.push_back(fades_.back().opacity());
  }
  // The first frame shows every scene, so that the encoder allocates its largest buffer.
  largest_frame_bytes_ = encoder_.encode({}, skeletons_, poses_).size();
}

void Animation::step(const wind::ground::DrivingWind& wind, double dt_s) noexcept {
  const wind::ground::GroundWind ground = written_to(tapes_, wind);
  for (std::size_t i = 0; i < scenes_.size(); ++i) {
    fades_[i].advance(dt_s);
    opacities_[i] = fades_[i].opacity();
    if (opacities_[i] == 0.0F) continue;
    scenes::Scene& scene = *scenes_[i];
    scene.shift(gains_[i] * ground, dt_s);
    pool_.run([&scene](Part part) { scene.sample_part(part); });
    pool_.run([&scene, dt_s](Part part) { scene.project_part(part, dt_s); });
  }
}

void Animation::cue(const SceneCue& cue) noexcept {
  if (cue.scene >= fades_.size()) return;
  if (cue.hide_others) {
    for (Fade& fade : fades_) fade.begin(false, cue.over_s);
  }
  fades_[cue.scene].begin(cue.shown, cue.over_s);
}

wire::Scenes Animation::describe() const {
  wire::Scenes all;
  for (std::size_t index = 0; index < scenes_.size(); ++index) {
    all.scenes.push_back({names_[index], kinds_[index], *skeletons_[index]});
  }
  return all;
}

std::size_t Animation::node_count() const {
  std::size_t nodes = 0;
  for (const pose::Skeleton* skeleton : skeletons_) nodes += pose::node_count(*skeleton);
  return nodes;
}

}  // namespace yuragi::daemon::animation
