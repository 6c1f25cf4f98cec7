#include "daemon/tools/sensors/device_list.hpp"

#include <algorithm>
#include <exception>
#include <future>
#include <iterator>
#include <map>
#include <sstream>

#include <fmt/format.h>

namespace yuragi::daemon::tools::sensors {
namespace {

std::string indented(const std::string& text, std::string_view margin) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) result += fmt::format("{}{}\n", margin, line);
  return result;
}

/// The findings of one device stand together, in the order in which it was first found.
std::vector<std::vector<const DeviceFinding*>> by_device(std::span<const DeviceFinding> findings) {
  std::vector<std::vector<const DeviceFinding*>> groups;
  for (const DeviceFinding& finding : findings) {
    const auto same = std::ranges::find_if(
        groups, [&](const auto& group) { return group.front()->device.what == finding.device.what; });
    if (same == groups.end()) {
      groups.push_back({&finding});
    } else {
      same->push_back(&finding);
    }
  }
  return groups;
}

std::string names_of(std::span<const drivers::sensor::DriverDescription* const> drivers, bool that_can_search) {
  std::string names;
  for (const drivers::sensor::DriverDescription* driver : drivers) {
    if ((driver->find != nullptr) == that_can_search)
      names += fmt::format("{}{}", names.empty() ? "" : ", ", driver->name);
  }
  return names;
}

/// What a driver's search finds, or that it failed.
template <class Search>
std::vector<DeviceFinding> findings_of(const drivers::sensor::DriverDescription* driver, Search&& search) {
  std::vector<DeviceFinding> findings;
  try {
    for (drivers::sensor::FoundDevice& device : search()) findings.push_back({driver, std::move(device)});
  } catch (const std::exception& error) {
    drivers::sensor::FoundDevice none;
    none.what = fmt::format("devices of driver {}", driver->name);
    none.trouble = fmt::format("search failed: {}", error.what());
    findings.push_back({driver, std::move(none)});
  }
  return findings;
}

}  // namespace

std::vector<DeviceFinding> find_devices(std::span<const drivers::sensor::DriverDescription* const> drivers) {
  std::vector<DeviceFinding> findings;
  for (const drivers::sensor::DriverDescription* driver : drivers) {
    if (driver->find != nullptr) std::ranges::move(findings_of(driver, driver->find), std::back_inserter(findings));
  }
  return findings;
}

std::vector<DeviceFinding> find_devices_in_network(std::span<const drivers::sensor::DriverDescription* const> drivers,
                                                   const drivers::sensor::NetworkSearch& search) {
  std::vector<std::future<std::vector<DeviceFinding>>> searches;
  for (const drivers::sensor::DriverDescription* driver : drivers) {
    if (driver->find_in_network == nullptr) continue;
    searches.push_back(std::async(std::launch::async, [driver, &search] {
      return findings_of(driver, [&] { return driver->find_in_network(search); });
    }));
  }
  std::vector<DeviceFinding> findings;
  for (auto& each : searches) std::ranges::move(each.get(), std::back_inserter(findings));
  return findings;
}

std::string device_list(std::span<const DeviceFinding> findings,
                        std::span<const drivers::sensor::DriverDescription* const> drivers) {
  std::string text;
  const auto out = std::back_inserter(text);
  if (findings.empty()) {
    const std::string searched = names_of(drivers, true);
    fmt::format_to(out, "No device found that a driver could read{}.\n",
                   searched.empty() ? "" : fmt::format(" (looked for devices of {})", searched));
  }

  // Names of sensors must be unique: the second of a driver is "modbus-2".
  std::map<std::string_view, int> count_of;
  for (const auto& group : by_device(findings)) {
    fmt::format_to(out, "{}\n", group.front()->device.what);
    const DeviceFinding* shown = nullptr;
    for (const DeviceFinding* finding : group) {
      const drivers::sensor::FoundDevice& device = finding->device;
      if (!device.settings.empty()) {
        const int count = ++count_of[finding->driver->name];
        const std::string number = count > 1 ? fmt::format("-{}", count) : "";
        if (finding != group.front()) fmt::format_to(out, "  or\n");
        fmt::format_to(out, "    [[sensor]]\n    name = \"{0}{1}\"\n    driver = \"{0}\"\n{2}", finding->driver->name,
                       number, indented(device.settings, "    "));
      }
      // The same trouble is shown once.
      const bool is_shown =
          shown != nullptr && shown->device.trouble == device.trouble && shown->device.remedy == device.remedy;
      if (device.trouble.empty() || is_shown) continue;
      shown = finding;
      fmt::format_to(out, "  It cannot be opened:\n{}", indented(device.trouble, "    "));
      if (!device.remedy.empty()) fmt::format_to(out, "  What to do:\n{}", indented(device.remedy, "    "));
    }
    text += '\n';
  }

  if (const std::string others = names_of(drivers, false); !others.empty()) {
    fmt::format_to(out, "{}Not searched for: {}. `yuragi sensors describe DRIVER` describes how to set up each.\n",
                   findings.empty() ? "\n" : "", others);
  }
  return text;
}

}  // namespace yuragi::daemon::tools::sensors
