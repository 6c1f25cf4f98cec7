#pragma once

#include <memory>

#include "simulators/usb/hid_model.hpp"

namespace yuragi::simulators::usb {

/// An Oregon Scientific WMR300 console with its wind, thermometer and rain packets.
std::unique_ptr<Device> make_wmr300(const HidModelOptions& options);

}  // namespace yuragi::simulators::usb
