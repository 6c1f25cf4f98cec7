#include "simulators/usb/daqs.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "simulators/usb/labjack.hpp"
#include "simulators/usb/mcc1208.hpp"

namespace yuragi::simulators::usb {
namespace {

struct KnownDaq {
  std::string_view name;
  std::unique_ptr<Device> (*make)();
};
constexpr std::array<KnownDaq, 2> kKnownDaqs = {{{"mcc1208", make_mcc1208}, {"labjack-u3", make_labjack}}};

}  // namespace

std::vector<std::string> daq_names() {
  std::vector<std::string> names;
  names.reserve(kKnownDaqs.size());
  for (const KnownDaq& daq : kKnownDaqs) names.emplace_back(daq.name);
  return names;
}

std::unique_ptr<Device> make_daq(std::string_view name) {
  const auto found = std::ranges::find(kKnownDaqs, name, &KnownDaq::name);
  if (found == kKnownDaqs.end()) {
    throw std::runtime_error(
        fmt::format("no simulated USB device \"{}\"; known: {}", name, fmt::join(daq_names(), ", ")));
  }
  return found->make();
}

}  // namespace yuragi::simulators::usb
