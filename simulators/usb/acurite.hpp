#pragma once

#include <memory>

#include "simulators/usb/hid_model.hpp"

namespace yuragi::simulators::usb {

/// An AcuRite 01035 console, in USB mode 3 or 4.
std::unique_ptr<Device> make_acurite(const HidModelOptions& options);

}  // namespace yuragi::simulators::usb
