#pragma once

#include <memory>

#include "simulators/usb/usb_device.hpp"

namespace yuragi::simulators::usb {

/// A simulated LabJack U3-HV. See CupAndVane for what is wired to it: the cup to FIO4.
std::unique_ptr<Device> make_labjack();

}  // namespace yuragi::simulators::usb
