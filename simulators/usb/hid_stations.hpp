#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "simulators/usb/usb_device.hpp"

namespace yuragi::simulators::usb {

/// The stations of make_hid_station(): wmr100, wmr300, fineoffset (WH1080), fineoffset-wh3080, acurite, te923.
std::vector<std::string_view> hid_station_names();

/// A USB HID weather station. `pace`: how many times as fast as the real one it runs: with 20 a Fine Offset console
/// writes its record every 2.4 s, not every 48 s (USB itself keeps its speed). `seed`: of the bytes of the garbage
/// fault. Throws std::runtime_error for an unknown name.
std::unique_ptr<Device> make_hid_station(std::string_view name, double pace = 1.0, std::uint64_t seed = 1);

}  // namespace yuragi::simulators::usb
