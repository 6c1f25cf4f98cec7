#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulators/text/text_simulator.hpp"

namespace yuragi::simulators::text {

/// The formats of make_line_device(): csv, key-value.
std::vector<std::string> line_format_names();

/// A microcontroller that prints numbers: speed in m/s and direction in degrees, "4.20,270.0" or "speed=4.20
/// direction=270.0". Its request is a line with "?". Throws std::runtime_error for an unknown format.
std::unique_ptr<Device> make_line_device(const std::string& format);

}  // namespace yuragi::simulators::text
