#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/parameter.hpp"
#include "engine/look/cloth_look.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::daemon::settings {

/// A scene of an installation.
struct SceneConfig {
  std::string name;
  const scenes::SceneDescription* kind = nullptr;
  ParameterValues values{};  ///< its kind's own parameters, and common_scene_parameters()

  scenes::ScenePlacement placement{};
  double wind_gain = 1.0;   ///< factor on the wind speed
  bool is_shown = true;     ///< from the start
  look::ClothLook cloth{};  ///< of a flag, a banner or a curtain
};

/// All keys of a [[scene]] of this kind, besides name and kind: its own, and common_scene_parameters().
std::vector<Parameter> scene_parameters(const scenes::SceneDescription& kind);

/// Is a scene made anew where this key of it changes? Otherwise it goes on as it is.
bool remakes_scene(std::string_view key) noexcept;

/// Is it a file, which is read with the configuration alone?
bool names_file(std::string_view key) noexcept;

/// `values`: of common_scene_parameters() and of the kind's own parameters.
SceneConfig scene_config_of(std::string name, const scenes::SceneDescription& kind, ParameterValues values);

/// What a cloth of these values looks like. Its picture's path begins at `folder`; without a folder no picture is read.
Result<look::ClothLook, std::vector<ParameterError>> cloth_look_of(const ParameterValues& values,
                                                                   const std::optional<std::filesystem::path>& folder);

}  // namespace yuragi::daemon::settings
