#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/parameter.hpp"
#include "engine/look/cloth_look.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::daemon::settings {

/// A scene of an installation.
struct SceneConfig {
  std::string name;
  const scenes::Description* kind = nullptr;
  ParameterValues values{};  ///< its kind's own parameters, and common_scene_parameters()

  scenes::Placement placement{};
  double wind_gain = 1.0;   ///< factor on the wind speed
  bool is_shown = true;     ///< from the start
  look::ClothLook cloth{};  ///< of a flag, a banner or a curtain
};

/// The keys that scenes of every kind have: place, gain, whether it is shown.
std::span<const Parameter> common_scene_parameters();

/// What a new value of a key of a [[scene]] does, unless the key states it.
inline constexpr KeyChange kSceneKeyChange = KeyChange::kCrossFade;

/// All keys of a [[scene]] of this kind, besides name and kind: its own, and common_scene_parameters().
std::vector<Parameter> scene_parameters(const scenes::Description& kind);

/// `values`: of common_scene_parameters() and of the kind's own parameters.
SceneConfig scene_config_of(std::string name, const scenes::Description& kind, ParameterValues values);

/// What a cloth of these values looks like. Its picture's path begins at `folder`; without a folder no picture is read.
Result<look::ClothLook, std::vector<ParameterError>> cloth_look_of(const ParameterValues& values,
                                                                   const std::optional<std::filesystem::path>& folder);

}  // namespace yuragi::daemon::settings
