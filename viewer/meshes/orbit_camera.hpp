#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/frustum.hpp"
#include "viewer/meshes/shore.hpp"

namespace yuragi::viewer::meshes {

/// Where the wind comes from if the sender does not report it: the default of [wind] default_direction.
inline constexpr double kUsualWindFrom_deg = 240.0;

/// The position of a camera that orbits a target and never rolls.
struct CameraPlace {
  glm::dvec3 target_m{0.0};
  double heading_deg = 0.0;       ///< direction of view: 0 north, 90 east
  double pitch_deg = 10.0;        ///< of the view below level; negative: upward
  double distance_m = 5.0;        ///< from the target
  double field_of_view_deg = 40;  ///< from the bottom of the picture to its top, at 16:9; see tangent_up()

  friend bool operator==(const CameraPlace&, const CameraPlace&) = default;
};

/// The eye of a place.
glm::dvec3 eye_of(const CameraPlace& place);

/// The tangent of half the field of view from bottom to top in a picture of width / height `aspect`. At 16:9 it is that
/// of `field_of_view_deg`. In other pictures the product of visible height and width stays the same: an upright one
/// shows less at the sides and more above and below, and a very broad one is not distorted at its ends.
double tangent_up(double field_of_view_deg, double aspect);

/// A camera that the user turns, shifts and moves nearer and farther; it follows these movements smoothly. Pure: time
/// is a parameter. Thread-safe: no. Its place is always finite and within the limits below.
class OrbitCamera {
 public:
  static constexpr double kMinPitch_deg = -45.0;
  static constexpr double kMaxPitch_deg = 89.0;
  static constexpr double kMinEye_m = 0.08;  ///< above the ground
  static constexpr double kMinDistance_m = 0.2;
  static constexpr double kMaxDistance_m = 200.0;

  /// Moves to the place at once, and makes it the place to which reset() returns.
  void frame(const CameraPlace& place);
  void reset() { wanted_ = home_; }
  /// Sets the place to which reset() returns. Moves there at once if it is at the old one, apart from its heading while
  /// it turns; otherwise does not move.
  void move_home(const CameraPlace& place);
  /// Moves to the place at once; reset() returns to the same place as before.
  void go_to(const CameraPlace& place);

  /// The user's drags, as shares of the picture's height; `right` and `down` are the screen's.
  void orbit(double right, double down);
  /// `aspect`: the picture's width / height.
  void pan(double right, double down, double aspect);
  /// Turns of the wheel; above 0 is nearer.
  void zoom(double notches);

  /// Sets the minimum distance from its target, which limits zooming in.
  void keep_away(double distance_m);

  /// Lets it orbit by itself, slowly.
  void set_turning(bool is_turning) { is_turning_ = is_turning; }
  bool is_turning() const { return is_turning_; }

  /// Advances by dt_s.
  void advance(double dt_s);

  /// From now on uses this frustum, whatever its field of view and the picture's shape; nullopt: uses those again.
  void see_through(const std::optional<Frustum>& frustum) { frustum_ = frustum; }

  const CameraPlace& place() const { return place_; }
  glm::dvec3 eye_m() const { return eye_of(place_); }

  glm::mat4 view() const;
  /// Its view in a picture of width / height `aspect`.
  Frustum frustum(double aspect) const;
  /// For such a picture; near and far planes fit the distance.
  glm::mat4 projection(double aspect) const;

 private:
  CameraPlace home_;
  CameraPlace wanted_;
  CameraPlace place_;
  bool is_turning_ = false;
  std::optional<Frustum> frustum_;
};

/// Returns the heading nearest to `preferred_deg` that looks across the wind, so that things lean to the picture's
/// side: |sin(heading - wind_from_deg)| >= 0.86. Of the two sides of the wind it takes the one that is nearer to
/// `broadside_deg`, the heading that sees a thing at its broadest; it is never more than 60 degrees from that.
double heading_across(double preferred_deg, double broadside_deg, double wind_from_deg);

/// A low place from which to view the content of `bounds`, across the wind and toward the evening sun's side: across a
/// field from just inside its edge, and at something small from outside.
CameraPlace place_across(const Bounds& bounds, double wind_from_deg = kUsualWindFrom_deg);

/// How far from the middle of `bounds` a camera with this direction and field of view sees all of it in a picture of
/// width / height `aspect`.
double distance_to_see(const Bounds& bounds, const CameraPlace& place, double aspect);

/// A low place outside of `bounds`, across the wind, at its broad side and toward the evening sun's side. Upright
/// things are completely in a picture of width / height `aspect`, before the sky; flat ones, such as water, fill its
/// width.
CameraPlace place_around(const Bounds& bounds, double aspect, double wind_from_deg = kUsualWindFrom_deg);

/// A low place at the near shore of a pond, from which the water extends from the picture's lower edge to the far
/// shore, and the horizon is visible: across the wind, toward the evening sun's side.
CameraPlace place_on_shore(const Shore& shore, double wind_from_deg = kUsualWindFrom_deg);

/// A place so close to the broad side of something that bulges out of the ground that it fills the picture's lower part
/// from side to side, across the wind, lit from the side by the evening sun.
CameraPlace place_beside(const Bounds& bounds, double wind_from_deg = kUsualWindFrom_deg);

}  // namespace yuragi::viewer::meshes
