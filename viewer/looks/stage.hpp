#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/look/look.hpp"
#include "viewer/gl/mirror.hpp"
#include "viewer/gl/pass_marks.hpp"
#include "viewer/gl/render_target.hpp"
#include "viewer/gl/screen_door.hpp"
#include "viewer/gl/shadow_map.hpp"
#include "viewer/gl/view_buffer.hpp"
#include "viewer/light/sky_keeper.hpp"
#include "viewer/looks/ground_maps.hpp"
#include "viewer/looks/landscape.hpp"
#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/sward.hpp"
#include "viewer/meshes/shore.hpp"
#include "viewer/meshes/view.hpp"
#include "viewer/stream/pose_moment.hpp"

namespace yuragi::viewer::looks {

/// All scene views, each with its SceneRenderer, in a landscape. Needs a current context; on its thread.
class Stage {
 public:
  /// Replaces the scenes. A scene of the same kind, skeleton and cloth as before keeps its GPU data. If the only scene
  /// that was drawn is removed, all are drawn.
  void set_scenes(std::vector<wire::SceneModel> scenes);
  const std::vector<const wire::SceneModel*>& scenes() const { return scenes_; }

  /// Draws only the scene of this name; all if there is no name.
  void show_only(std::optional<std::string> name) { only_ = std::move(name); }
  /// Draws only the first scene, then only the next, and after the last all again.
  void show_next();
  bool shows_all() const { return !only_; }

  /// The box around all scenes that are drawn, and the camera's first place for a picture of width / height `aspect`.
  meshes::Bounds bounds() const;
  meshes::CameraPlace home(double aspect, double wind_from_deg = meshes::kUsualWindFrom_deg) const;
  /// The boxes around the drawn scenes that an eye must not enter: all except grass, ground and water.
  std::vector<meshes::Bounds> obstacles() const;
  /// Returns a camera's place, moved back along its view if it is within a body.
  meshes::CameraPlace outside(const meshes::CameraPlace& place) const;
  /// The box around the scene of this name; nullopt if there is none.
  std::optional<meshes::Bounds> bounds_of(std::string_view scene) const;
  /// How many joints move in all scenes.
  std::size_t node_count() const;

  /// The light of the next pictures; at first the evening's.
  void set_light(const light::Light& light) { light_ = light; }

  /// How much work the next pictures are; at first little. kLow has hard shadows, on the ground only; kAuto is kHigh.
  void set_quality(look::Quality quality);

  /// From now on draws only this share (0 to 1] of the quality's blades of grass; initially all.
  void set_blade_share(float share) { blade_share_ = share; }

  /// From now on meshes are those of a picture whose pixels are this many times as large (1 or more).
  void set_coarseness(float coarseness) { coarseness_ = coarseness; }

  /// From now on the sky is left out: where it was, the picture is transparent, and its colors are multiplied by their
  /// alpha.
  void leave_sky_out() { has_sky_ = false; }

  /// Draws `moment` into `target`, and resolves it. Scenes whose pose does not fit their skeleton are left out.
  void draw(const stream::PoseMoment& moment, const meshes::OrbitCamera& camera, gl::RenderTarget& target);

  /// From now on the passes of each picture are marked: kinematics, each kind of scene, their shadows, the sward, the
  /// landscape, lights. Null: no more. Must outlive the drawing.
  void mark_passes_for(gl::PassMarks* marks) { marks_ = marks; }

 private:
  struct SceneView {
    wire::SceneModel scene;
    meshes::Bounds bounds;
    std::unique_ptr<SceneRenderer> renderer;
    meshes::BendGrid grid;               // of the ground
    std::optional<meshes::Stand> stand;  // of grass
    meshes::Shore shore;                 // of water
  };

  /// Where in a picture a scene can be visible.
  struct Seen {
    bool in_picture = false;
    bool in_shadow = false;  // it casts a shadow that can be visible
    bool in_mirror = false;

    bool is_anywhere() const { return in_picture || in_shadow || in_mirror; }
  };

  bool is_chosen(std::size_t scene) const { return !only_ || scenes_[scene]->name == *only_; }
  template <class IsChosen>
  std::optional<meshes::Bounds> around(IsChosen&& is_chosen) const;
  bool is_there(const stream::PoseMoment& moment, std::size_t scene) const;
  void look_around(const stream::PoseMoment& moment, const meshes::View& view);
  void choose_mirror(const meshes::View& view);
  void draw_mirror(const stream::PoseMoment& moment, const meshes::View& view, const gl::RenderTarget& target);
  void draw_shadow_map(const stream::PoseMoment& moment, const glm::vec3& to_sun, meshes::View& view);
  void mark_pass(std::string_view name) {
    if (marks_ != nullptr) marks_->mark(name);
  }
  void move_to(const stream::PoseMoment& moment);
  void move_ground(const stream::PoseMoment& moment);
  void draw_sward(const meshes::View& view);

  std::vector<std::unique_ptr<SceneView>> views_;  // a renderer refers to its scene, which must not move in memory
  std::vector<const wire::SceneModel*> scenes_;    // of views_
  std::optional<std::string> only_;
  std::vector<Seen> seen_;             // of the present picture
  std::optional<meshes::View> image_;  // the mirror image of the water in view
  light::Light light_ = light::light_of({}, 0.0);
  std::vector<light::Fire> fires_;
  Landscape landscape_;
  GroundMaps ground_;
  std::vector<meshes::Standing> standing_;
  meshes::Stand stand_;  // of the tall grass, of which this share is visible
  float tall_ = 0.0F;
  std::size_t tall_door_ = 0;
  std::optional<Sward> meadow_, lawn_;  // made when first needed
  std::optional<meshes::Stand> meadow_stand_;
  gl::ScreenDoor door_;
  gl::ViewBuffer view_buffer_;
  float blade_share_ = 1.0F;
  float coarseness_ = 1.0F;
  bool has_sky_ = true;
  look::Quality quality_ = look::Quality::kLow;
  std::optional<gl::ShadowMap> shadow_map_;  // created when the sun first shines
  std::optional<gl::Mirror> mirror_;         // created when water first becomes visible
  gl::PassMarks* marks_ = nullptr;
};

}  // namespace yuragi::viewer::looks
