#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::tools::sensors {

/// The state of a recording that is played, on one line for a person.
std::string player_text(const wire::PlayerState& player);

}  // namespace yuragi::daemon::tools::sensors
