#pragma once

#include <optional>

#include "engine/look/camera.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/orbit_camera.hpp"

namespace yuragi::viewer {

/// Where a camera of the daemon's is at a moment (seconds since 1970, UTC): its place, and its slow moves, as
/// engine/wire/pose.fbs tells them. `scene`: the box around what it looks at; nothing: the middle of the world.
/// `aspect`: the picture's width / height. Pure, and smooth in time.
meshes::CameraPlace place_of(const look::Camera& camera, const std::optional<meshes::Bounds>& scene, double aspect,
                             double utc_s);

}  // namespace yuragi::viewer
