#include "daemon/tools/doctor/service_judgements.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace yuragi::daemon::tools::doctor {
namespace {

constexpr std::uint32_t kRead = 4;
constexpr std::uint32_t kWrite = 2;
constexpr std::uint32_t kPass = 1;
constexpr int kNotFoundByTheLoader = 127;

Finding service(Verdict verdict, std::string text, std::string remedy) {
  return {verdict, "service", std::move(text), std::move(remedy)};
}

bool is_in(const std::string& path, std::string_view folder) {
  return path.starts_with(folder) && (path.size() == folder.size() || folder == "/" || path[folder.size()] == '/');
}

bool is_in_any(const std::string& path, const auto& folders) {
  return std::ranges::any_of(folders, [&](std::string_view folder) { return is_in(path, folder); });
}

/// Returns true if the unit's user may do that with a node, by its mode.
bool may(const ServiceUnit& unit, const Node& node, std::uint32_t rights) {
  if (unit.user_id == 0U || node.has_acl) return true;
  // systemd gives it to the user when the service starts.
  if (std::ranges::find(unit.folders, node.path) != unit.folders.end()) return true;
  std::uint32_t granted = node.mode;
  if (unit.user_id == node.owner) {
    granted = node.mode >> 6;
  } else if (std::ranges::find(unit.group_ids, node.group) != unit.group_ids.end()) {
    granted = node.mode >> 3;
  }
  return (granted & rights) == rights;
}

std::uint32_t needed_rights(PathUse use) {
  switch (use) {
    case PathUse::kList:
      return kRead | kPass;
    case PathUse::kWriteFolder:
      return kWrite | kPass;
    case PathUse::kWriteFile:
    case PathUse::kDevice:
      return kRead | kWrite;
    case PathUse::kRead:
    case PathUse::kReadSecret:
      break;
  }
  return kRead;
}

bool is_written(PathUse use) {
  return use == PathUse::kWriteFolder || use == PathUse::kWriteFile;
}

std::string who(const ServiceUnit& unit) {
  return unit.name.empty() ? fmt::format("the user {}", unit.user)
                           : fmt::format("the user {} of {}", unit.user, unit.name);
}

std::string group_of(const ServiceUnit& unit) {
  return unit.group.empty() ? unit.user : unit.group;
}

/// The unit without ".service", for `systemctl edit`.
std::string edit(const ServiceUnit& unit) {
  return fmt::format("sudo systemctl edit {}, [Service] ", unit.name.substr(0, unit.name.rfind('.')));
}

std::string move_away(const PathFacts& path, const ServiceUnit& unit) {
  const std::string place = unit.folders.empty() ? "a folder that the service sees" : unit.folders.front();
  if (is_written(path.use)) return fmt::format("write a path in {} into the configuration", place);
  return fmt::format("sudo cp {} {}/, and write that path into the configuration", path.node.path, place);
}

/// Nullopt if the service sees the path.
std::optional<Finding> hidden(const PathFacts& path, const ServiceUnit& unit) {
  constexpr std::array<std::string_view, 3> kHomes = {"/home", "/root", "/run/user"};
  constexpr std::array<std::string_view, 2> kTmps = {"/tmp", "/var/tmp"};
  const auto is_hidden = [&](const auto& folders) {
    return is_in_any(path.node.path, folders) ||
           std::ranges::any_of(path.folders, [&](const Node& folder) { return is_in_any(folder.path, folders); });
  };
  const std::string named = fmt::format("{}: {}: ", path.what, path.node.path);
  if (unit.hides_home && is_hidden(kHomes)) {
    return service(Verdict::kError, named + unit.name + " cannot see /home and /root (ProtectHome=)",
                   move_away(path, unit));
  }
  if (unit.has_own_tmp && is_hidden(kTmps)) {
    return service(Verdict::kError, named + unit.name + " has its own /tmp (PrivateTmp=)", move_away(path, unit));
  }
  return std::nullopt;
}

std::string remedy_for_missing(const PathFacts& path, const ServiceUnit& unit) {
  switch (path.use) {
    case PathUse::kReadSecret:
      return fmt::format(
          "create it (a token: `yuragi token --config FILE --new`); then sudo chown root:{0} {1}; "
          "sudo chmod 640 {1}",
          group_of(unit), path.node.path);
    case PathUse::kWriteFolder:
      return fmt::format("sudo install -d -o {} -g {} -m 750 {}", unit.user, group_of(unit), path.node.path);
    case PathUse::kDevice:
      return "plug it in, and write one of the names that `yuragi sensors list` shows";
    case PathUse::kRead:
    case PathUse::kList:
    case PathUse::kWriteFile:
      break;
  }
  return fmt::format("put it there, or write another path into the configuration: ls -l {}", path.node.path);
}

std::string remedy_for_rights(const PathFacts& path, const ServiceUnit& unit) {
  const Node& node = path.node;
  const std::uint32_t rights = needed_rights(path.use);
  switch (path.use) {
    case PathUse::kDevice:
      // A group that may not use it either would not help, and root's is given to nobody.
      if (((node.mode >> 3) & rights) != rights || node.group == 0) {
        return "sudo cp config/udev/70-yuragi.rules /etc/udev/rules.d/ (the package has it); plug the device in again";
      }
      return unit.name.empty() ? fmt::format("sudo adduser {} {}   (and log in again)", unit.user, node.group_name)
                               : edit(unit) + "SupplementaryGroups=" + node.group_name;
    case PathUse::kWriteFolder:
    case PathUse::kWriteFile:
      return fmt::format("sudo chown {}:{} {}", unit.user, group_of(unit), node.path);
    case PathUse::kReadSecret:
      return fmt::format("sudo chgrp {0} {1}; sudo chmod 640 {1}", group_of(unit), node.path);
    case PathUse::kRead:
    case PathUse::kList:
      break;
  }
  return fmt::format("sudo chgrp {} {}; sudo chmod g+{} {}", group_of(unit), node.path,
                     path.use == PathUse::kList ? "rx" : "r", node.path);
}

/// Nullopt if the service may write there, as far as its unit and the disk decide.
std::optional<Finding> write_protected(const PathFacts& path, const ServiceUnit& unit) {
  const Node& node = path.node;
  const std::string named = fmt::format("{}: {}: ", path.what, node.path);
  if (is_in_any(node.path, unit.folders) || is_in_any(node.path, unit.writable)) return std::nullopt;
  constexpr std::array<std::string_view, 3> kSystem = {"/usr", "/boot", "/etc"};
  const bool is_strict = unit.protects_system == "strict";
  const bool is_full = unit.protects_system == "full";
  const bool is_protected = is_strict || (!unit.protects_system.empty() && is_in_any(node.path, kSystem) &&
                                          (is_full || !is_in(node.path, "/etc")));
  if (is_protected) {
    return service(Verdict::kError,
                   named + unit.name + " may not write there (ProtectSystem=" + unit.protects_system + ")",
                   edit(unit) + "ReadWritePaths=" + node.path);
  }
  if (node.is_read_only) {
    return service(Verdict::kError, named + "the disk is read-only", fmt::format("findmnt --target {}", node.path));
  }
  return std::nullopt;
}

std::vector<Finding> judge_access(const PathFacts& path, const ServiceUnit& unit) {
  const Node& node = path.node;
  const std::string named = fmt::format("{}: {}: ", path.what, node.path);
  const auto folder = std::ranges::find_if(path.folders, [&](const Node& one) { return !may(unit, one, kPass); });
  if (folder != path.folders.end()) {
    return {service(Verdict::kError,
                    fmt::format("{}{} may not enter {} (mode {:o})", named, who(unit), folder->path, folder->mode),
                    fmt::format("sudo chgrp {0} {1}; sudo chmod g+x {1}", group_of(unit), folder->path))};
  }
  if (may(unit, node, needed_rights(path.use))) return {};
  return {service(Verdict::kError,
                  fmt::format("{}{} may not {} it (mode {:o}, group {})", named, who(unit),
                              path.use == PathUse::kDevice ? "open" : (is_written(path.use) ? "write" : "read"),
                              node.mode, node.group_name),
                  remedy_for_rights(path, unit))};
}

}  // namespace

std::vector<Finding> judge(const ServiceUnit& unit) {
  if (unit.user_id) return {};
  return {service(Verdict::kError, fmt::format("{}: there is no user {} on this machine", unit.name, unit.user),
                  fmt::format("sudo systemd-sysusers; or sudo adduser --system --group {}", unit.user))};
}

std::vector<Finding> judge(const PathFacts& path, const ServiceUnit& unit) {
  const Node& node = path.node;
  const std::string named = fmt::format("{}: {}: ", path.what, node.path);
  if (auto finding = hidden(path, unit)) return {*finding};
  if (node.is_unseen) {
    return {service(Verdict::kWarning, named + "only root may look at it: its permissions are not checked",
                    "the same command with sudo")};
  }
  const bool is_made = std::ranges::find(unit.folders, node.path) != unit.folders.end();
  if (!node.is_there && !is_made) {
    if (path.is_optional) return {};
    const bool is_device = path.use == PathUse::kDevice;
    std::vector<Finding> findings = {
        service(is_device ? Verdict::kWarning : Verdict::kError,
                named + (is_device ? "is not plugged in: its permissions are not checked" : "is missing"),
                remedy_for_missing(path, unit))};
    if (auto finding = is_written(path.use) ? write_protected(path, unit) : std::nullopt) findings.push_back(*finding);
    return findings;
  }
  if (is_written(path.use)) {
    if (auto finding = write_protected(path, unit)) return {*finding};
  }
  std::vector<Finding> findings = judge_access(path, unit);
  const bool is_forbidden = path.use == PathUse::kDevice && unit.has_closed_devices && !node.device_classes.empty() &&
                            std::ranges::find_first_of(unit.devices, node.device_classes) == unit.devices.end() &&
                            std::ranges::find(unit.devices, node.path) == unit.devices.end();
  if (is_forbidden) {
    findings.push_back(service(Verdict::kError, named + unit.name + " allows no device of this kind (DeviceAllow=)",
                               edit(unit) + fmt::format("DeviceAllow={} rw", node.device_classes.back())));
  }
  return findings;
}

std::vector<Finding> judge(const ListenFacts& listen, const ServiceUnit& unit) {
  if (listen.is_own) return {};
  const std::string named = fmt::format("{}: {}: ", listen.what, listen.address);
  if (listen.port > 0 && listen.port < listen.first_unprivileged_port) {
    if (unit.user_id != 0U && !unit.may_use_low_ports) {
      return {service(
          Verdict::kError,
          fmt::format("{}{} may not listen on ports below {}", named, who(unit), listen.first_unprivileged_port),
          unit.name.empty() ? fmt::format("choose port {} or a higher one", listen.first_unprivileged_port)
                            : fmt::format("choose port {} or a higher one; or {}AmbientCapabilities="
                                          "CAP_NET_BIND_SERVICE and CapabilityBoundingSet="
                                          "CAP_NET_BIND_SERVICE",
                                          listen.first_unprivileged_port, edit(unit)))};
    }
    if (!listen.listener) return {};  // the current user may lack the right to listen there
  }
  // The running service gives it up before it is started again.
  const bool is_the_service = !unit.name.empty() && listen.listener && listen.listener == unit.user_id;
  if (listen.trouble.empty() || is_the_service) return {};
  return {service(Verdict::kError, named + "cannot listen here: " + listen.trouble,
                  listen.listener ? fmt::format("sudo ss -lntup 'sport = :{}'", listen.port)
                                  : std::string("ip address; write an address of this machine"))};
}

std::vector<Finding> judge(const ProgramFacts& program, const ServiceUnit& unit) {
  const std::string named = fmt::format("{} starts {}, ", unit.name, program.path);
  if (!program.is_there) {
    return {service(Verdict::kError, named + "which is not installed",
                    program.path.find("yuragi") == std::string::npos ? "sudo apt install xinit xserver-xorg-core"
                                                                     : "sudo apt install ./yuragi_VERSION_amd64.deb")};
  }
  if (program.exit_code != kNotFoundByTheLoader) return {};
  return {service(
      Verdict::kError, named + "which lacks a library: " + program.text.substr(0, program.text.find('\n')),
      fmt::format("ldd {} | grep 'not found'; sudo apt install --reinstall ./yuragi_VERSION_amd64.deb", program.path))};
}

std::vector<Finding> judge(const MonitorFacts& monitor) {
  const std::string named = fmt::format("[[output]] {}: monitor {}", monitor.output, monitor.monitor);
  if (!monitor.present) {
    return {service(Verdict::kOk, named + ": not checked, because no display can be reached from here", {})};
  }
  const bool is_number = monitor.monitor.find_first_not_of("0123456789") == std::string::npos;
  const bool is_there = is_number ? monitor.monitor.size() < 4 &&
                                        static_cast<std::size_t>(std::stoi(monitor.monitor)) < monitor.present->size()
                                  : std::ranges::find(*monitor.present, monitor.monitor) != monitor.present->end();
  if (is_there) return {};
  return {service(Verdict::kError,
                  fmt::format("{} is not connected; there {}: {}", named, monitor.present->size() == 1 ? "is" : "are",
                              monitor.present->empty() ? "none" : fmt::format("{}", fmt::join(*monitor.present, ", "))),
                  "connect it and switch it on; yuragi-viewer --list-monitors shows the names")};
}

}  // namespace yuragi::daemon::tools::doctor
