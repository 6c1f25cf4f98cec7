#pragma once

#include <memory>

#include "simulators/usb/usb_device.hpp"

namespace yuragi::simulators::usb {

/// A simulated MCC USB-1208FS-Plus. See CupAndVane for what is wired to it.
std::unique_ptr<Device> make_mcc1208();

}  // namespace yuragi::simulators::usb
