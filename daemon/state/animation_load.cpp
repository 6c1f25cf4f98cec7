#include "daemon/state/animation_load.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace yuragi::daemon::state {

std::optional<double> carried_times(const wire::AnimationStatus& animation) {
  if (!(animation.tick_s > 0.0)) return std::nullopt;
  return kCarriedShare * animation.period_s / animation.tick_s;
}

double share_of(const wire::SceneCost& scene, const wire::AnimationStatus& animation) {
  return animation.tick_s > 0.0 ? std::min(scene.tick_s / animation.tick_s, 1.0) : 0.0;
}

std::string animation_text(const wire::AnimationStatus& animation) {
  std::string text =
      fmt::format("{:.2f} ms of work in each {:.2f} ms", 1e3 * animation.tick_s, 1e3 * animation.period_s);
  const std::optional<double> times = carried_times(animation);
  if (times && *times >= 1.0) text += fmt::format("; this machine carries {:.1f} times as much", *times);
  if (times && *times < 1.0) text += "; that is much for this machine: show fewer or smaller scenes";
  return text;
}

}  // namespace yuragi::daemon::state
