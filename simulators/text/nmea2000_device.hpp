#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulators/text/text_simulator.hpp"

namespace yuragi::simulators::text {

/// The formats of make_nmea2000_device(): yacht-devices, canboat, canboat-si.
std::vector<std::string> nmea2000_format_names();

/// A gateway to an NMEA 2000 bus with one anemometer of address 35, whose angles count from its mark. Throws
/// std::runtime_error for an unknown format.
std::unique_ptr<TextDevice> make_nmea2000_device(const std::string& format);

}  // namespace yuragi::simulators::text
