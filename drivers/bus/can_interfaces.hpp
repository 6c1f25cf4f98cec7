#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace yuragi::drivers::bus {

/// A CAN interface that this machine has.
struct CanInterfaceInfo {
  std::string name;     ///< "can0"
  std::string trouble;  ///< the reason why nothing can be received there; empty: it can
  std::string remedy;   ///< the command to type
};

/// The kernel's list of network interfaces; tests use a folder of their own.
inline constexpr const char* kNetworkInterfaces = "/sys/class/net";

/// The CAN interfaces, by hardware or virtual, in the order of their names. Opens none of them. Thread-safe: yes.
std::vector<CanInterfaceInfo> find_can_interfaces(const std::filesystem::path& classes = kNetworkInterfaces);

/// Why a CAN interface could not be opened, which gave this `errno`, and the command to type. Pure.
std::string can_trouble(const std::string& interface, int error);

/// The command that switches an interface on, with NMEA 2000's bit rate if it is not virtual. Pure.
std::string can_up_command(const std::string& interface);

}  // namespace yuragi::drivers::bus
