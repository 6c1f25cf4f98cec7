#pragma once

#include <optional>
#include <span>

#include "engine/look/camera.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/orbit_camera.hpp"

namespace yuragi::viewer::picture {

/// Where a camera of the daemon's is at a moment (seconds since 1970, UTC): its place, and its slow moves, as
/// engine/wire/pose.fbs defines them. `scene`: the box around its target; nullopt: the middle of the world. `aspect`:
/// the picture's width / height. Pure, and smooth in time.
///
/// A camera with a wind_angle looks by that angle to the right of `view_wind_from_deg` (its own heading if that is not
/// known). Its distance does not depend on its heading, so that it enters none of the `obstacles` while it turns about
/// its target: a distance that is too short is made longer (clear_distance_m()).
meshes::CameraPlace place_of(const look::Camera& camera, const std::optional<meshes::Bounds>& scene, double aspect,
                             double utc_s, std::optional<double> view_wind_from_deg = std::nullopt,
                             std::span<const meshes::Bounds> obstacles = {});

/// Returns the shortest distance from the target, at least `distance_m`, at which an eye with this pitch is outside of
/// every box, whatever its heading.
double clear_distance_m(const meshes::CameraPlace& place, double distance_m, std::span<const meshes::Bounds> obstacles);

}  // namespace yuragi::viewer::picture
