#pragma once

#include <cstddef>

#include "engine/base/parameter.hpp"

namespace yuragi {

/// [animation]: the pace.
struct AnimationConfig {
  double rate_hz = 0.0;     ///< poses a second; the wind goes on at the same pace
  std::size_t threads = 1;  ///< that share a tick
};

/// Of the values of animation_parameters().
AnimationConfig animation_config_of(const ParameterValues& values);

}  // namespace yuragi
