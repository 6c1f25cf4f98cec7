#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace yuragi::drivers::bus {

/// A serial port that this machine has.
struct SerialPortInfo {
  std::string name;     ///< the most stable name that it has: under /dev/serial/by-id, by-path, or /dev/ttyS0
  std::string node;     ///< its device file, which may be another one after the next start: /dev/ttyUSB0
  std::string trouble;  ///< why this user cannot open it; empty: he can
  std::string remedy;   ///< what to do about that
};

/// The system's lists of serial ports; tests use folders of their own.
struct SerialPortPlaces {
  std::filesystem::path devices = "/dev";
  std::filesystem::path classes = "/sys/class/tty";
};

/// The serial ports that are plugged in, in the order of their names: USB adapters (ttyUSB, ttyACM) and built-in ports
/// (ttyS, ttyAMA) behind which the kernel has found a chip. Opens none of them. A folder that is missing holds none.
/// Thread-safe: yes.
std::vector<SerialPortInfo> find_serial_ports(const SerialPortPlaces& places = {});

/// The identity of a serial port for comparison with others: "serial port " and the device file to which its name,
/// which can be a link, leads; the name itself if it leads nowhere.
std::string serial_device_of(const std::filesystem::path& name);

/// Why this process cannot open `node` for reading and writing, and what to do about it; both empty: it can. `node` is
/// any device file.
struct AccessTrouble {
  std::string trouble;
  std::string remedy;
};
AccessTrouble access_trouble(const std::filesystem::path& node);

}  // namespace yuragi::drivers::bus
