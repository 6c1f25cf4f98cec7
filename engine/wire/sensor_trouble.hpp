#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::wire {

/// What is wrong with a sensor and what to do about it, for printing after its name: "is stale: no reading for 5 min";
/// "sends no direction: none for 3 min of wind". Empty: nothing. Pure.
std::string trouble_of(const SensorStatus& sensor);

}  // namespace yuragi::wire
