#pragma once

#include <string>

#include "engine/base/parameter.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::daemon::settings {

/// A scene of an installation.
struct SceneConfig {
  std::string name;
  const scenes::SceneDescription* kind = nullptr;
  ParameterValues values{};  ///< its kind's own parameters, and common_scene_parameters()

  scenes::ScenePlacement placement{};
  double wind_gain = 1.0;  ///< factor on the wind speed
  bool is_shown = true;    ///< from the start
};

/// `values`: of common_scene_parameters() and of the kind's own parameters.
SceneConfig scene_config_of(std::string name, const scenes::SceneDescription& kind, ParameterValues values);

}  // namespace yuragi::daemon::settings
