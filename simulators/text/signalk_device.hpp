#pragma once

#include <memory>

#include "simulators/text/text_simulator.hpp"

namespace yuragi::simulators::text {

/// A Signal K server with one anemometer, whose angles count from its mark. It sends its hello to each client.
/// `is_asked`: it sends its wind only after a client has subscribed to it, and first, as servers do, a remembered value
/// of the day before (a storm); otherwise it sends deltas unasked, as a device does by UDP.
std::unique_ptr<Device> make_signalk_device(bool is_asked);

}  // namespace yuragi::simulators::text
