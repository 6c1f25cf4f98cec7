#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/usb/usb_device.hpp"

namespace yuragi::simulators::usb {

/// The counter and ADC devices that can be simulated: "mcc1208", "labjack-u3".
std::vector<std::string> daq_names();

/// One of them, with the cup and the vane of CupAndVane on its counter 0 and analogue input 0, and the vane's reference
/// of 5 V on analogue input 1. Throws std::runtime_error for another name.
std::unique_ptr<Device> make_daq(std::string_view name);

}  // namespace yuragi::simulators::usb
