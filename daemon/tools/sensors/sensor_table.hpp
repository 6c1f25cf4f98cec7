#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::tools::sensors {

/// The state of all sensors as a table for a terminal: the wind on top, where it is and how it is shaped, then a line
/// for each sensor, and under it why it is in its state, what its link did last and what was refused. No line is longer
/// than 100 columns, unless a single word is. Lines end in '\n'; nothing but text, no cursor movement.
std::string sensor_table(const wire::Sensors& sensors);

}  // namespace yuragi::daemon::tools::sensors
