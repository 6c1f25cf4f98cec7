#pragma once

#include <span>
#include <vector>

#include "daemon/settings/config.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::service {

/// The parameters of [look] and of every scene, as their tables describe them, with their values: of `running` now, of
/// `configured` in the file. `scenes`: which are shown; empty if the daemon has none. Secrets are not shown. Pure.
std::vector<wire::ParameterGroup> parameter_groups(const settings::Config& running, const settings::Config& configured,
                                                   std::span<const wire::SceneState> scenes);

/// The same without the folders of paths among the values: for clients of other machines.
std::vector<wire::ParameterGroup> without_folders(std::vector<wire::ParameterGroup> groups);

}  // namespace yuragi::daemon::service
