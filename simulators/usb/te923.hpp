#pragma once

#include <memory>

#include "simulators/usb/hid_model.hpp"

namespace yuragi::simulators::usb {

/// A Hideki TE923 console (Meade, TFA Nexus, Mebus, IROX).
std::unique_ptr<Device> make_te923(const HidModelOptions& options);

}  // namespace yuragi::simulators::usb
