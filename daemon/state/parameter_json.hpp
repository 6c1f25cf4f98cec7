#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "engine/wire/parameters.hpp"

namespace yuragi::daemon::state {

/// [look] and the scenes with all that is known of their parameters: a list with scene, kind and parameters. Values are
/// in their own type, null if they are left out. Pure.
nlohmann::ordered_json parameters_json(std::span<const wire::ParameterGroup> groups);

}  // namespace yuragi::daemon::state
