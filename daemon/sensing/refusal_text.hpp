#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::sensing {

/// "timeout 3, exception 1"; "nothing" if nothing was refused.
std::string refusal_text(const wire::SensorStatus& sensor);

}  // namespace yuragi::daemon::sensing
