#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/sensor/endpoint.hpp"
#include "engine/base/time.hpp"
#include "engine/platform/clock_offset.hpp"

namespace yuragi::daemon::tools::doctor {

// What the probes (machine_probe.hpp, sensor_probe.hpp) find, and the judgements (judgements.hpp) judge.

using drivers::sensor::EndpointKind;

constexpr bool is_usb(const std::optional<EndpointKind>& kind) noexcept {
  return kind == EndpointKind::kHid || kind == EndpointKind::kUsb;
}

/// One device that a sensor of the configuration names.
struct DeviceFacts {
  std::string sensor{};
  std::optional<EndpointKind> kind{};  ///< none: it needs no device
  std::string name{};                  ///< as the configuration calls it: "/dev/serial/by-id/...", "192.168.1.20:502"
  bool is_shared = false;              ///< a UDP port at which other programs may listen, too
  bool is_used = false;                ///< the running daemon has readings from this sensor; it was not touched then
  bool is_there = false;
  std::string trouble{};  ///< why it cannot be used; of the network: why it cannot be reached
  std::string remedy{};   ///< what to do about that, from the driver; can be empty
};

/// The user, and the groups of the sensors' devices.
struct GroupFacts {
  std::string user{};
  bool is_root = false;
  std::vector<std::string> groups{};         ///< the user's
  std::vector<std::string> needed_groups{};  ///< of the devices in the configuration
};

struct ClockFacts {
  UtcTime now{};
  std::optional<bool> is_synchronised{};  ///< by the kernel; nullopt: not known
  platform::ClockOffset offset{};
  bool is_of_wall = false;  ///< an [[output]] has a delay: several machines must have the same time
};

/// The folder of a recording.
struct DiskFacts {
  std::string folder{};
  bool is_there = false;
  bool is_writable = false;
  std::string user{};
  std::optional<double> free_bytes{};
  double least_free_bytes = 0.0;  ///< [recording] min_free
  double bytes_a_day = 0.0;       ///< expected
  bool is_bounded = false;        ///< old files are deleted by [recording] keep_days or max_size
};

/// The address that the daemon is to listen on.
struct PortFacts {
  std::string address{};
  std::string trouble{};  ///< why it cannot be listened on; empty: it can
  std::string daemon{};   ///< "yuragi 0.2.0": the daemon that replies there; empty: none of ours
  std::uint16_t port = 0;
  bool is_in_use = false;
};

struct ConfigFacts {
  std::string file{};                  ///< empty: the built-in configuration
  std::string error{};                 ///< what is wrong with it, a line for each; empty: nothing
  std::vector<std::string> exposed{};  ///< secrets that others can read, from settings::exposed_secrets()
};

/// A server by which daemons share one wind ([wind] lead, follow).
struct CompanyServerFacts {
  std::string server{};
  std::string channel{};
  bool needs_leader = false;  ///< this daemon follows
  bool is_connected = false;
  bool is_led = false;    ///< a leader's tick came
  std::string trouble{};  ///< why there is no connection; of a connection: what the server does not permit
};

struct DisplayFacts {
  std::vector<std::string> graphics{};  ///< /dev/dri/card0 ...
  std::string graphics_trouble{};       ///< why they cannot be opened
  std::string graphics_remedy{};
  bool has_display = false;             ///< $DISPLAY, $WAYLAND_DISPLAY, or an X server's socket
  std::optional<std::string> viewer{};  ///< "yuragi-viewer 0.2.0"; none: it is not installed
};

struct VersionFacts {
  std::string program{};                 ///< "yuragi 0.2.0"
  std::string version{};                 ///< "0.2.0"
  std::optional<std::string> viewer{};   ///< as above
  std::string daemon{};                  ///< of the daemon that runs; empty: none does
  std::vector<std::string> libraries{};  ///< as they are loaded: "libmodbus.so.5.1.0"
  std::string kernel{};                  ///< "Linux 6.1.0-26-amd64"
  std::string system{};                  ///< "Debian GNU/Linux 12 (bookworm)"
};

struct LimitFacts {
  std::uint64_t open_files = 0;         ///< the soft limit
  std::uint64_t most_open_files = 0;    ///< the hard one
  std::uint64_t needed_open_files = 0;  ///< of this configuration
  std::optional<std::uint64_t> available_memory_bytes{};
};

}  // namespace yuragi::daemon::tools::doctor
