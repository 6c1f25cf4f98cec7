#pragma once

#include <memory>

#include "simulators/usb/hid_model.hpp"

namespace yuragi::simulators::usb {

/// An Oregon Scientific WMR100 console with its wind, thermometer, pressure and clock frames.
std::unique_ptr<Device> make_wmr100(const HidModelOptions& options);

}  // namespace yuragi::simulators::usb
