#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi::daemon::tools::doctor {

/// The daemon's unit.
inline constexpr const char* kServiceUnit = "yuragi.service";

/// What a unit of systemd allows its program. A new one allows everything.
struct ServiceUnit {
  std::string name{};  ///< "yuragi.service"; empty: not a unit, but the process that asks
  std::string user = "root";
  std::string group{};                  ///< empty: the user's own
  std::vector<std::string> groups{};    ///< SupplementaryGroups=
  std::vector<std::string> folders{};   ///< that systemd makes for the user, and that may be written: StateDirectory=
  std::vector<std::string> writable{};  ///< ReadWritePaths=
  std::string working_folder = "/";
  std::vector<std::string> command{};  ///< ExecStart=
  bool hides_home = false;             ///< ProtectHome=
  bool has_own_tmp = false;            ///< PrivateTmp=
  std::string protects_system{};       ///< ProtectSystem=: "", "yes", "full" or "strict"
  bool has_closed_devices = false;     ///< DevicePolicy=closed or strict: only `devices`
  std::vector<std::string> devices{};  ///< DeviceAllow=, without rights: "char-ttyUSB", "/dev/ttyS0"
  bool may_use_low_ports = false;      ///< CAP_NET_BIND_SERVICE

  /// Of the user and its groups on this machine; nullopt: there is no such user.
  std::optional<std::uint32_t> user_id{};
  std::vector<std::uint32_t> group_ids{};
};

/// Reads a unit's text, with its drop-ins behind it. As systemd does, an empty value empties a list. Unknown keys are
/// ignored. The ids are those of nobody. Pure.
ServiceUnit parse_unit(std::string name, std::string_view text);

/// The unit as it is installed on this machine, with its drop-ins and the user's ids; nullopt: it is not installed.
std::optional<ServiceUnit> installed_unit(const std::string& name);

/// The unit of a file, with the user's ids. Throws FailureError if it cannot be read.
ServiceUnit unit_of_file(const std::filesystem::path& file);

/// The user, the groups and the working folder of this process, which meets its own sandbox when it looks.
ServiceUnit this_process();

}  // namespace yuragi::daemon::tools::doctor
