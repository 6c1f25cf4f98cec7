#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulators/text/text_simulator.hpp"

namespace yuragi::sim {

/// The names that make_line_device() knows formats by: csv, key-value.
std::vector<std::string> line_format_names();

/// A microcontroller that prints numbers: speed in m/s and direction in degrees, "4.20,270.0" or "speed=4.20
/// direction=270.0". It is asked by a line with "?". Throws std::runtime_error for a format that it does not know.
std::unique_ptr<TextDevice> make_line_device(const std::string& format);

}  // namespace yuragi::sim
