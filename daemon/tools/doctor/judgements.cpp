#include "daemon/tools/doctor/judgements.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace yuragi::daemon::tools::doctor {
namespace {

Finding ok(std::string area, std::string text) {
  return {Verdict::kOk, std::move(area), std::move(text), {}};
}
Finding warning(std::string area, std::string text, std::string remedy) {
  return {Verdict::kWarning, std::move(area), std::move(text), std::move(remedy)};
}
Finding error(std::string area, std::string text, std::string remedy) {
  return {Verdict::kError, std::move(area), std::move(text), std::move(remedy)};
}

/// "192.168.1.20" of "192.168.1.20:502", "::1" of "[::1]:502".
std::string host_of(const std::string& address) {
  const std::string host = address.substr(0, address.rfind(':'));
  return host.starts_with('[') && host.ends_with(']') ? host.substr(1, host.size() - 2) : host;
}

std::string_view title_of(const std::optional<EndpointKind>& kind) {
  if (!kind) return "";
  switch (*kind) {
    case EndpointKind::kSerialPort:
      return "serial port ";
    case EndpointKind::kSoundCard:
      return "sound card ";
    case EndpointKind::kBroker:
      return "MQTT broker ";
    case EndpointKind::kUdpPort:
      return "UDP port ";
    case EndpointKind::kTcpPort:
      return "TCP port ";
    case EndpointKind::kFile:
      return "file ";
    case EndpointKind::kHid:
    case EndpointKind::kUsb:
    case EndpointKind::kServer:
      break;
  }
  return "";
}

/// Returns the command that shows why a device is missing or cannot be reached.
std::string remedy_for_absent(const DeviceFacts& device) {
  switch (device.kind.value_or(EndpointKind::kFile)) {
    case EndpointKind::kSerialPort:
      return "plug it in, and write one of the names that `yuragi sensors list` shows";
    case EndpointKind::kHid:
    case EndpointKind::kUsb:
      return "plug it in; `yuragi sensors list` shows what is found, `lsusb` everything on the bus";
    case EndpointKind::kSoundCard:
      return "plug it in, and write a name that `yuragi sensors list` shows; `arecord -l` lists the cards";
    case EndpointKind::kServer:
      return fmt::format("ping -c 3 {}; check its power, cable and address", host_of(device.name));
    case EndpointKind::kBroker:
      return fmt::format("ping -c 3 {}; on the broker's machine: systemctl status mosquitto", host_of(device.name));
    case EndpointKind::kUdpPort:
      return fmt::format("sudo ss -lunp 'sport = :{}'", device.name.substr(device.name.rfind(':') + 1));
    case EndpointKind::kTcpPort:
      return fmt::format("sudo ss -ltnp 'sport = :{}'", device.name.substr(device.name.rfind(':') + 1));
    case EndpointKind::kFile:
      break;
  }
  return fmt::format("ls -l {}", device.name);
}

}  // namespace

Finding judge(const DeviceFacts& device) {
  const std::string what = fmt::format("{}: {}{}", device.sensor, title_of(device.kind), device.name);
  if (device.is_used) return ok("sensor", what + ": the running daemon has readings from it");
  if (!device.kind) return ok("sensor", what);
  if (!device.is_there) {
    const std::string why = device.trouble.empty() ? "was not found" : device.trouble;
    return error("sensor", what + ": " + why, remedy_for_absent(device));
  }
  if (!device.trouble.empty()) {
    return error("sensor", what + ": " + device.trouble,
                 device.remedy.empty() ? remedy_for_absent(device) : device.remedy);
  }
  return ok("sensor", what);
}

std::vector<Finding> judge(const GroupFacts& groups) {
  if (groups.is_root) {
    return {
        ok("permissions", "root may open everything: ask again as the user that the daemon runs as (sudo -u yuragi)")};
  }
  std::vector<Finding> findings;
  for (const std::string& group : groups.needed_groups) {
    if (std::ranges::find(groups.groups, group) != groups.groups.end()) continue;
    findings.push_back(warning(
        "permissions",
        fmt::format("the user {} is not in the group {}, whose devices the configuration names", groups.user, group),
        fmt::format("sudo adduser {} {}   (and log in again)", groups.user, group)));
  }
  if (findings.empty()) {
    findings.push_back(ok("permissions", fmt::format("the user {} has the groups that the devices need", groups.user)));
  }
  return findings;
}

Finding judge(const ClockFacts& clock) {
  const auto day = std::chrono::floor<std::chrono::days>(clock.now);
  const int year = static_cast<int>(std::chrono::year_month_day(day).year());
  const std::time_t seconds = std::chrono::floor<std::chrono::seconds>(clock.now.time_since_epoch()).count();
  const std::string time = fmt::format("{:%Y-%m-%dT%H:%M:%S}Z", fmt::gmtime(seconds));
  if (year < kFirstPlausibleYear || year > kLastPlausibleYear) {
    return error("clock", "it shows " + time + ", which is impossible: recordings and opening hours would be wrong",
                 "sudo timedatectl set-ntp true; without a network: sudo timedatectl set-time 'YYYY-MM-DD hh:mm:ss'");
  }
  if (clock.is_synchronised == false) {
    return warning("clock", time + ", but no time server sets it: it will drift",
                   "sudo apt install systemd-timesyncd; sudo timedatectl set-ntp true");
  }
  if (clock.is_of_wall && (clock.offset.is_large() || !clock.offset.offset_s)) {
    return warning("clock",
                   fmt::format("{}; {}; the screens of a wall with [[output]] delay are in step up to 5 ms", time,
                               text_of(clock.offset)),
                   "sudo apt install chrony on every machine of the wall, with one of them, or one server, as the "
                   "server of all; chronyc tracking");
  }
  const std::string offset = clock.offset.offset_s ? "; " + text_of(clock.offset) : std::string();
  return ok("clock", time + (clock.is_synchronised ? ", set by a time server" : "") + offset);
}

Finding judge(const DiskFacts& disk) {
  if (!disk.is_there) {
    return error("disk", disk.folder + ": the folder for the recording does not exist",
                 fmt::format("sudo install -d -o yuragi -g yuragi -m 750 {}", disk.folder));
  }
  if (!disk.is_writable) {
    return error("disk", fmt::format("{}: the user {} may not write there", disk.folder, disk.user),
                 fmt::format("sudo chown {} {}; or ask as the daemon's user: sudo -u yuragi yuragi doctor", disk.user,
                             disk.folder));
  }
  if (!disk.free_bytes) {
    return warning("disk", disk.folder + ": its free space cannot be determined", fmt::format("df -h {}", disk.folder));
  }
  const double spare_bytes = *disk.free_bytes - disk.least_free_bytes;
  const std::string text = fmt::format("{}: {:.1f} GB free, about {:.1f} MB a day", disk.folder,
                                       1e-9 * *disk.free_bytes, 1e-6 * disk.bytes_a_day);
  if (spare_bytes <= 0.0) {
    return error("disk",
                 fmt::format("{}, less than the {:.0f} MB to keep free ([recording] min_free): nothing new is "
                             "recorded when the oldest files are deleted",
                             text, 1e-6 * disk.least_free_bytes),
                 fmt::format("sudo du -xsh {}/* | sort -h; delete or move what is not needed", disk.folder));
  }
  const double days = disk.bytes_a_day > 0.0 ? spare_bytes / disk.bytes_a_day : 1e9;
  if (!disk.is_bounded && days < kSoonFull_days) {
    return warning("disk", fmt::format("{}: full in {:.0f} days", text, days),
                   "set rotate = \"day\" and keep_days or max_size in [recording]");
  }
  return ok("disk", text);
}

Finding judge(const PortFacts& port) {
  if (!port.daemon.empty()) return ok("port", fmt::format("{}: {} replies", port.address, port.daemon));
  if (port.trouble.empty()) return ok("port", port.address + " is free; no daemon runs");
  const std::string remedy = port.is_in_use
                                 ? fmt::format("sudo ss -ltnp 'sport = :{}'", port.port)
                                 : std::string("ip address; write an address of this machine in [stream] listen");
  return error("port", fmt::format("cannot listen on {}: {}", port.address, port.trouble), remedy);
}

Finding judge(const CompanyServerFacts& server) {
  if (!server.is_connected) {
    const std::string host = host_of(server.server.substr(server.server.find("://") + 3));
    return error("company",
                 fmt::format("{}: {}", server.server, server.trouble.empty() ? "it does not reply" : server.trouble),
                 fmt::format("ping -c 3 {}; on that machine: systemctl status nats-server", host));
  }
  if (!server.trouble.empty()) {
    return error("company", fmt::format("{}: {}", server.server, server.trouble),
                 "compare the server's permissions with those of leader-and-followers.conf; [wind] credentials");
  }
  if (server.is_led)
    return ok("company", fmt::format("{}: a leader is heard on the channel {}", server.server, server.channel));
  if (server.needs_leader) {
    return warning("company", fmt::format("{}: no leader is heard on the channel {}", server.server, server.channel),
                   "start the leader; its [wind] channel has to be the same, and its servers connected to this one");
  }
  return ok("company", server.server + ": connected");
}

std::vector<Finding> judge(const ConfigFacts& config) {
  if (!config.error.empty())
    return {error("configuration", config.error, fmt::format("yuragi check-config {}", config.file))};
  std::vector<Finding> findings;
  for (const std::string& sentence : config.exposed) {
    // It ends with the command: "...; chmod 640 FILE".
    const std::size_t end = sentence.rfind("; ");
    findings.push_back(warning("configuration", sentence.substr(0, end),
                               end == std::string::npos ? std::string() : sentence.substr(end + 2)));
  }
  if (findings.empty()) {
    findings.push_back(
        ok("configuration", config.file.empty() ? "the built-in one: synthetic wind" : config.file + ": no errors"));
  }
  return findings;
}

std::vector<Finding> judge(const DisplayFacts& display) {
  std::vector<Finding> findings;
  if (display.graphics.empty()) {
    findings.push_back(warning("graphics", "the kernel has no graphics device (/dev/dri): the viewer draws on the CPU",
                               "lspci -k | grep -A 3 -i vga; sudo apt install firmware-misc-nonfree"));
  } else if (!display.graphics_trouble.empty()) {
    findings.push_back(warning("graphics",
                               fmt::format("{}: {}", fmt::join(display.graphics, ", "), display.graphics_trouble),
                               display.graphics_remedy));
  } else {
    findings.push_back(ok("graphics", fmt::format("{}", fmt::join(display.graphics, ", "))));
  }
  if (!display.viewer) {
    findings.push_back(warning("display",
                               "yuragi-viewer is not installed here: it is needed on the machine of the wall",
                               "sudo apt install ./yuragi_VERSION_amd64.deb"));
  } else if (!display.has_display) {
    findings.push_back(warning("display", "no X server and no Wayland compositor runs: the viewer cannot draw",
                               "sudo systemctl enable --now yuragi-viewer@7"));
  } else {
    findings.push_back(ok("display", "an X server or a Wayland compositor runs"));
  }
  return findings;
}

std::vector<Finding> judge(const VersionFacts& versions) {
  std::vector<Finding> findings = {ok("version", fmt::format("{}; {}; {}; {}", versions.program, versions.system,
                                                             versions.kernel, fmt::join(versions.libraries, ", ")))};
  if (versions.viewer && *versions.viewer != "yuragi-viewer " + versions.version) {
    findings.push_back(warning("version",
                               fmt::format("{} and {} are different versions", *versions.viewer, versions.program),
                               "install both from one package: sudo apt install ./yuragi_VERSION_amd64.deb"));
  }
  if (!versions.daemon.empty() && versions.daemon != versions.program) {
    findings.push_back(warning("version",
                               fmt::format("{} runs, but {} is installed", versions.daemon, versions.program),
                               "sudo systemctl restart yuragi"));
  }
  return findings;
}

std::vector<Finding> judge(const LimitFacts& limits) {
  std::vector<Finding> findings;
  if (limits.open_files < limits.needed_open_files) {
    const std::string remedy =
        limits.most_open_files >= limits.needed_open_files
            ? fmt::format(
                  "ulimit -n {}; of the service: systemctl edit yuragi, [Service] "
                  "LimitNOFILE={}",
                  limits.needed_open_files, limits.needed_open_files)
            : fmt::format("systemctl edit yuragi, [Service] LimitNOFILE={}", limits.needed_open_files);
    findings.push_back(error("limits",
                             fmt::format("{} open files are allowed, and this configuration may need {}",
                                         limits.open_files, limits.needed_open_files),
                             remedy));
  } else {
    findings.push_back(ok("limits", fmt::format("{} open files are allowed, {} may be needed", limits.open_files,
                                                limits.needed_open_files)));
  }
  if (limits.available_memory_bytes && *limits.available_memory_bytes < kLittleMemory_bytes) {
    findings.push_back(warning(
        "limits",
        fmt::format("only {:.0f} MB of memory are free", 1e-6 * static_cast<double>(*limits.available_memory_bytes)),
        "ps -eo rss,comm --sort -rss | head"));
  }
  return findings;
}

}  // namespace yuragi::daemon::tools::doctor
