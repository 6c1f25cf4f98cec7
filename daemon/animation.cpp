#include "daemon/animation.hpp"

#include "engine/pose/pose_arrays.hpp"

namespace yuragi {

Animation::Animation(const Config& config) {
  for (const SceneConfig& scene : config.scenes) {
    names_.push_back(scene.name);
    kinds_.emplace_back(scene.kind->name);
    scenes_.push_back(scene.kind->make(scene.values, {.seed = config.seed + scenes_.size()}));
    skeletons_.push_back(&scenes_.back()->skeleton());
    poses_.push_back(&scenes_.back()->pose());
  }
}

void Animation::step(WindVector wind, double dt_s) noexcept {
  for (const auto& scene : scenes_) scene->tick(wind, dt_s);
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
  for (const Skeleton* skeleton : skeletons_) nodes += yuragi::node_count(*skeleton);
  return nodes;
}

}  // namespace yuragi
