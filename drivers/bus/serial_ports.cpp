#include "drivers/bus/serial_ports.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace yuragi::drivers::bus {
namespace {

namespace fs = std::filesystem;

/// Each adapter is plugged in somewhere, so that it exists; built-in ports are listed whether they exist or not.
constexpr std::array<std::string_view, 2> kAdapters = {"ttyUSB", "ttyACM"};
constexpr std::array<std::string_view, 2> kBuiltIn = {"ttyS", "ttyAMA"};

bool is_numbered(std::string_view name, std::string_view prefix) {
  const std::string_view number = name.substr(std::min(prefix.size(), name.size()));
  return name.starts_with(prefix) && !number.empty() && number.find_first_not_of("0123456789") == number.npos;
}

/// The kernel lists 32 ports of a PC whether they are there or not; `type` is 0 for those without a chip.
bool has_chip(const fs::path& classes, const std::string& name) {
  std::ifstream in(classes / name / "type");
  int type = 0;
  return in >> type && type != 0;
}

/// Device files with the links in `folder` that lead to them.
std::map<fs::path, std::string> links_in(const fs::path& folder) {
  std::map<fs::path, std::string> links;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path node = fs::canonical(entry.path(), ignored);
    if (!ignored) links.emplace(node, entry.path().string());
  }
  return links;
}

/// Returns the name of a group in /etc/group; its number if it has none.
std::string group_name(gid_t group) {
  std::ifstream in("/etc/group");
  for (std::string line; std::getline(in, line);) {
    // name:password:number:members
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first == line.npos ? first : first + 1);
    if (second == line.npos) continue;
    const std::string_view rest = std::string_view(line).substr(second + 1);
    if (rest.substr(0, rest.find(':')) == std::to_string(group)) return line.substr(0, first);
  }
  return std::to_string(group);
}

}  // namespace

AccessTrouble access_trouble(const fs::path& node) {
  if (faccessat(AT_FDCWD, node.c_str(), R_OK | W_OK, AT_EACCESS) == 0) return {};
  const int error = errno;
  struct stat status {};
  if (error != EACCES || stat(node.c_str(), &status) != 0) {
    return {"cannot be opened (" + std::generic_category().message(error) + ")", "plug the device in again"};
  }
  // A group that may not write either would not help.
  const bool group_may = (status.st_mode & S_IRGRP) != 0 && (status.st_mode & S_IWGRP) != 0;
  if (!group_may || status.st_gid == 0) {
    return {"this user has no permission to open it",
            "install config/udev/*.rules into /etc/udev/rules.d, and plug it in again"};
  }
  const std::string group = group_name(status.st_gid);
  return {
      fmt::format("this user has no permission to open it: it belongs to the group {}", group),
      fmt::format("sudo usermod -a -G {} $USER, then log in again (a service: SupplementaryGroups={})", group, group)};
}

std::string serial_device_of(const fs::path& name) {
  std::error_code error;
  const fs::path node = fs::canonical(name, error);
  return "serial port " + (error ? name : node).string();
}

std::vector<SerialPortInfo> find_serial_ports(const SerialPortPlaces& places) {
  const auto by_id = links_in(places.devices / "serial/by-id");
  const auto by_path = links_in(places.devices / "serial/by-path");

  std::vector<SerialPortInfo> ports;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(places.devices, ignored)) {
    const std::string name = entry.path().filename().string();
    const auto is_named = [&name](std::string_view prefix) { return is_numbered(name, prefix); };
    const bool exists = std::ranges::any_of(kAdapters, is_named) ||
                        (std::ranges::any_of(kBuiltIn, is_named) && has_chip(places.classes, name));
    if (!exists) continue;

    // The names that follow the device, or else the socket that it is plugged into, outlast a restart.
    SerialPortInfo port{.name = entry.path().string(), .node = entry.path().string(), .trouble = {}, .remedy = {}};
    const fs::path node = fs::canonical(entry.path(), ignored);
    if (const auto link = by_id.find(node); link != by_id.end()) {
      port.name = link->second;
    } else if (const auto socket = by_path.find(node); socket != by_path.end()) {
      port.name = socket->second;
    }
    AccessTrouble access = access_trouble(entry.path());
    port.trouble = std::move(access.trouble);
    port.remedy = std::move(access.remedy);
    ports.push_back(std::move(port));
  }
  std::ranges::sort(ports, {}, &SerialPortInfo::name);
  return ports;
}

}  // namespace yuragi::drivers::bus
