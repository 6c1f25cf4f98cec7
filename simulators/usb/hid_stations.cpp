#include "simulators/usb/hid_stations.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "simulators/usb/acurite.hpp"
#include "simulators/usb/fineoffset.hpp"
#include "simulators/usb/te923.hpp"
#include "simulators/usb/wmr100.hpp"
#include "simulators/usb/wmr300.hpp"

namespace yuragi::simulators::usb {
namespace {

struct HidStationKind {
  std::string_view name;
  std::unique_ptr<Device> (*make)(const HidModelOptions& options);
};

template <FineOffsetRecord kRecord>
std::unique_ptr<Device> make_fineoffset(const HidModelOptions& options) {
  return std::make_unique<FineOffset>(kRecord, options);
}

constexpr std::array<HidStationKind, 6> kHidStationKinds = {
    {{"wmr100", make_wmr100},
     {"wmr300", make_wmr300},
     {"fineoffset", make_fineoffset<FineOffsetRecord::kWh1080>},
     {"fineoffset-wh3080", make_fineoffset<FineOffsetRecord::kWh3080>},
     {"acurite", make_acurite},
     {"te923", make_te923}}};

}  // namespace

std::vector<std::string_view> hid_station_names() {
  std::vector<std::string_view> names;
  names.reserve(kHidStationKinds.size());
  for (const HidStationKind& kind : kHidStationKinds) names.push_back(kind.name);
  return names;
}

std::unique_ptr<Device> make_hid_station(std::string_view name, double pace, std::uint64_t seed) {
  const auto kind = std::ranges::find(kHidStationKinds, name, &HidStationKind::name);
  if (kind == kHidStationKinds.end()) {
    throw std::runtime_error(
        fmt::format("no simulated station \"{}\"; known: {}", name, fmt::join(hid_station_names(), ", ")));
  }
  return kind->make({.pace = pace, .seed = seed});
}

}  // namespace yuragi::simulators::usb
