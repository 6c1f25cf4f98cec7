#pragma once

#include <span>

#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings {

/// What the table [shaping] may hold.
std::span<const Parameter> shaping_parameters();

}  // namespace yuragi::daemon::settings
