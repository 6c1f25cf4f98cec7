#include "daemon/settings/animation_config.hpp"

namespace yuragi::daemon::settings {

AnimationConfig animation_config_of(const ParameterValues& values) {
  return {.rate_hz = values.number("rate"), .threads = static_cast<std::size_t>(values.integer("threads"))};
}

}  // namespace yuragi::daemon::settings
