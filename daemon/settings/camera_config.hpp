#pragma once

#include <string>

#include "engine/base/parameter.hpp"
#include "engine/look/camera.hpp"

namespace yuragi::daemon::settings {

/// A [[camera]] of an installation.
struct CameraConfig {
  std::string name;
  ParameterValues values{};  ///< of look::camera_parameters()
  look::Camera camera{};     ///< made of these
};

}  // namespace yuragi::daemon::settings
