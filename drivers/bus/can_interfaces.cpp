#include "drivers/bus/can_interfaces.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iomanip>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <net/if.h>
#include <net/if_arp.h>

namespace yuragi::drivers::bus {
namespace {

namespace fs = std::filesystem;

/// The kernel's file of an interface: "280", "0x1003".
std::optional<int> number_in(const fs::path& file) {
  std::ifstream in(file);
  int number = 0;
  if (in >> std::setbase(0) >> number) return number;
  return {};
}

}  // namespace

std::vector<CanInterfaceInfo> find_can_interfaces(const fs::path& classes) {
  std::vector<CanInterfaceInfo> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(classes, ignored)) {
    if (number_in(entry.path() / "type") != ARPHRD_CAN) continue;
    CanInterfaceInfo info{.name = entry.path().filename().string(), .trouble = {}, .remedy = {}};
    if ((number_in(entry.path() / "flags").value_or(0) & IFF_UP) == 0) {
      info.trouble = "it is down";
      info.remedy = can_up_command(info.name);
    }
    found.push_back(std::move(info));
  }
  std::ranges::sort(found, {}, &CanInterfaceInfo::name);
  return found;
}

std::string can_up_command(const std::string& interface) {
  const bool is_virtual = interface.starts_with("vcan") || interface.starts_with("vxcan");
  return fmt::format("sudo ip link set {} up{}", interface, is_virtual ? "" : " type can bitrate 250000");
}

std::string can_trouble(const std::string& interface, int error) {
  switch (error) {
    case ENETDOWN:
      return fmt::format("the CAN interface {} is down: {}", interface, can_up_command(interface));
    case ENODEV:
    case ENXIO:
      return fmt::format(
          "there is no CAN interface {}: plug its adapter in, and check its name (ip link show type can)", interface);
    case EAFNOSUPPORT:
    case EPROTONOSUPPORT:
      return "this system has no CAN sockets: load the kernel module (sudo modprobe can_raw); for a systemd service "
             "also add AF_CAN to RestrictAddressFamilies";
    case EPERM:
    case EACCES:
      return fmt::format(
          "no permission to open the CAN interface {}: check the permissions of the service or container", interface);
    default:
      return fmt::format("cannot open the CAN interface {} ({}): check it with ip -details link show {}", interface,
                         std::generic_category().message(error), interface);
  }
}

}  // namespace yuragi::drivers::bus
