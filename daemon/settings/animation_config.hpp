#pragma once

#include <cstddef>

#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings {

/// [animation]: tick rate and threads.
struct AnimationConfig {
  double rate_hz = 0.0;     ///< ticks per second, of the wind and of the scenes
  std::size_t threads = 1;  ///< that share the work of a tick
};

/// From the values of animation_parameters().
AnimationConfig animation_config_of(const ParameterValues& values);

}  // namespace yuragi::daemon::settings
