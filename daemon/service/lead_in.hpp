#pragma once

#include <functional>

#include "daemon/animation/animation.hpp"
#include "daemon/sensing/held_clock.hpp"
#include "daemon/sensing/sensor_hub.hpp"

namespace yuragi::daemon::service {

/// Moves sensors, wind and scenes through the `lead_s` before a replay's first frame, on the caller's thread: holds the
/// clock in the past, and moves it tick by tick to the present. The recordings are then at the place at which they were
/// to begin, or a little further if the ticks have taken longer than the first ones promised. At last each sensor
/// gets a thread of its own.
///
/// All sensors of `hub` play recordings, are polled by the caller (SensorThread::kOfCaller), and have not been polled
/// yet. `next_wind` advances the hub. Takes about as long as the machine needs for so many ticks.
void lead_in(double lead_s, double rate_hz, sensing::HeldClock& clock, sensing::SensorHub& hub,
             const std::function<wind::ground::DrivingWind()>& next_wind, animation::Animation& animation);

}  // namespace yuragi::daemon::service
