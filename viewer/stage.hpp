#pragma once

#include <memory>
#include <vector>

#include "viewer/grass_look.hpp"
#include "viewer/landscape.hpp"
#include "viewer/pose_moment.hpp"
#include "viewer/render_target.hpp"
#include "viewer/view.hpp"

namespace yuragi {

/// Everything that stands in the picture: the scenes, each with the look of its kind of skeleton, in a landscape.
/// Needs a current context; on its thread.
class Stage {
 public:
  /// Takes the scenes; draws nothing of those before.
  void set_scenes(std::vector<wire::SceneModel> scenes);

  /// Around all scenes.
  const Bounds& bounds() const { return bounds_; }
  /// How many joints move.
  std::size_t node_count() const;

  /// Draws `moment`, whose layout is that of the scenes, into `target`, and resolves it.
  void draw(const PoseMoment& moment, const OrbitCamera& camera, RenderTarget& target);

 private:
  std::vector<wire::SceneModel> scenes_;
  std::vector<std::unique_ptr<GrassLook>> looks_;  // one a scene
  Bounds bounds_;
  Landscape landscape_;
  ViewBuffer view_buffer_;
};

}  // namespace yuragi
