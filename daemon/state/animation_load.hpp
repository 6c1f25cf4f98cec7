#pragma once

#include <optional>
#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::state {

/// The average part of each tick that a machine can use. The rest is for slower ticks, clients and other programs.
inline constexpr double kCarriedShare = 0.5;

/// How many times the present work of the animation this machine carries; nullopt if it is not known. Below 1 it is
/// too much. Pure.
std::optional<double> carried_times(const wire::AnimationStatus& animation);

/// The part of the animation's work that `scene` takes, 0 to 1.
double share_of(const wire::SceneCost& scene, const wire::AnimationStatus& animation);

/// "1.86 ms of work in each 16.67 ms; this machine carries 4.5 times as much". Pure.
std::string animation_text(const wire::AnimationStatus& animation);

}  // namespace yuragi::daemon::state
