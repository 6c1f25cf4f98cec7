#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulators/text/text_simulator.hpp"

namespace yuragi::simulators::text {

/// The formats of make_nmea2000_device(): yacht-devices, canboat, canboat-si, candump, canboat-plain, actisense.
std::vector<std::string> nmea2000_format_names();

/// The names of the references of an angle (north, magnetic, apparent, boat, water), by their numbers on the bus.
std::vector<std::string> nmea2000_reference_names();

/// A gateway to an NMEA 2000 bus with one anemometer of address 35. Throws std::runtime_error for an unknown format or
/// reference.
std::unique_ptr<Device> make_nmea2000_device(const std::string& format, const std::string& reference = "apparent");

/// The same anemometer on a bus of this machine's own: its messages are frames, for make_can_wire(). Its fault
/// `exception` is that of a controller that has left the bus.
std::unique_ptr<Device> make_nmea2000_can_device(const std::string& reference = "apparent");

}  // namespace yuragi::simulators::text
