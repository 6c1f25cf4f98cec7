#include "drivers/sensor/value_selection.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::drivers::sensor {
namespace {

bool part_covers(const SelectedPart& wide, const SelectedPart& narrow) {
  if (wide.value.empty() || wide.value == narrow.value) return true;
  return !narrow.value.empty() && wide.covers != nullptr && wide.covers(wide.value, narrow.value);
}

}  // namespace

bool covers(const ValueSelection& wide, const ValueSelection& narrow) {
  return wide.device == narrow.device && std::ranges::equal(wide.parts, narrow.parts, part_covers);
}

ValueSelection selection_at(const bus::BytePortAddress& address, std::vector<SelectedPart> parts) {
  return {.device = bus::device_of(address), .device_keys = bus::keys_of(address.kind), .parts = std::move(parts)};
}

bool list_covers(const std::string& wide, const std::string& narrow) {
  const auto enclosed = [](const std::string& list) { return "," + list + ","; };
  const std::string all = enclosed(wide);
  for (std::size_t begin = 0; begin <= narrow.size();) {
    const std::size_t end = std::min(narrow.find(',', begin), narrow.size());
    if (all.find(enclosed(narrow.substr(begin, end - begin))) == std::string::npos) return false;
    begin = end + 1;
  }
  return true;
}

}  // namespace yuragi::drivers::sensor
