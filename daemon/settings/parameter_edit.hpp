#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "daemon/settings/config.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::settings {

/// A value of [look] or of a scene, to be changed while the daemon runs.
struct ParameterEdit {
  std::string scene;  ///< its name; empty: [look]
  std::string key;
  std::optional<std::string> value;  ///< as typed_value() reads it; nullopt: back to the configuration's
};

/// `running` with these values. `configured`: what edits without a value go back to; a scene that it does not have goes
/// back to the defaults. A mistake in an edit is reported like the same value in a file: the error's name is
/// "look.haze", "scene.height". Neither a key of the file alone (a scene's name, kind) nor one that needs a restart can
/// be set. Pure.
Result<Config, ParameterError> edited(const Config& running, const Config& configured,
                                      std::span<const ParameterEdit> edits);

}  // namespace yuragi::daemon::settings
