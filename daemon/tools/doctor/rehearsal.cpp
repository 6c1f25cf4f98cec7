#include "daemon/tools/doctor/rehearsal.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <grp.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/sysmacros.h>
#include <sys/xattr.h>
#include <unistd.h>

#include "daemon/tools/doctor/local_port.hpp"
#include "daemon/tools/doctor/program_output.hpp"
#include "daemon/tools/doctor/sensor_probe.hpp"
#include "daemon/tools/doctor/service_judgements.hpp"
#include "engine/base/address.hpp"

namespace yuragi::daemon::tools::doctor {
namespace {

namespace fs = std::filesystem;

constexpr auto kProgramTimeout = std::chrono::seconds(5);
constexpr std::uint32_t kPermissions = 07777;

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::string group_name(gid_t id) {
  const group* const entry = getgrgid(id);  // NOLINT(concurrency-mt-unsafe): this thread alone looks up names
  return entry == nullptr ? std::to_string(id) : entry->gr_name;
}

/// "char-ttyUSB", as /proc/devices names the kind of a device file: one number may have several names.
std::vector<std::string> device_classes(const struct stat& status) {
  std::vector<std::string> classes;
  if (!S_ISCHR(status.st_mode)) return classes;
  std::ifstream in("/proc/devices");
  for (std::string line; std::getline(in, line) && !line.starts_with("Block");) {
    std::istringstream words(line);
    unsigned number = 0;
    std::string name;
    if (words >> number >> name && number == major(status.st_rdev)) classes.push_back("char-" + name);
  }
  return classes;
}

Node node_of(const fs::path& path) {
  Node node{.path = path};
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    node.is_unseen = errno == EACCES;
    return node;
  }
  node.is_there = true;
  node.mode = status.st_mode & kPermissions;
  node.owner = status.st_uid;
  node.group = status.st_gid;
  node.has_acl = getxattr(path.c_str(), "system.posix_acl_access", nullptr, 0) > 0;
  node.group_name = group_name(status.st_gid);
  node.device_classes = device_classes(status);
  struct statvfs system {};
  node.is_read_only = statvfs(path.c_str(), &system) == 0 && (system.f_flag & ST_RDONLY) != 0;
  return node;
}

std::vector<fs::path> folders_above(const fs::path& path) {
  std::vector<fs::path> folders;
  for (fs::path folder = path.parent_path(); folder != folder.parent_path(); folder = folder.parent_path())
    folders.insert(folders.begin(), folder);
  return folders;
}

/// The device files of USB devices with an id "0fde:ca01", which stands in parentheses in what a driver has found.
std::vector<fs::path> usb_nodes(const std::string& what, bool is_hid) {
  constexpr std::size_t kIdLength = 9;
  std::string id;
  for (std::size_t at = what.find('('); at != std::string::npos; at = what.find('(', at + 1)) {
    const std::string text = what.substr(at + 1, kIdLength);
    if (text.size() == kIdLength && text[4] == ':' && what[at + 1 + kIdLength] == ')') id = text;
  }
  std::vector<fs::path> nodes;
  std::error_code ignored;
  for (const auto& device : fs::directory_iterator("/sys/bus/usb/devices", ignored)) {
    if (id.empty() || first_line(device.path() / "idVendor") + ":" + first_line(device.path() / "idProduct") != id)
      continue;
    if (!is_hid) {
      const auto number = [&](const char* name) { return std::atoi(first_line(device.path() / name).c_str()); };
      nodes.emplace_back(fmt::format("/dev/bus/usb/{:03}/{:03}", number("busnum"), number("devnum")));
      continue;
    }
    for (const auto& raw : fs::directory_iterator("/sys/class/hidraw", ignored)) {
      const std::string place = fs::canonical(raw.path(), ignored);
      if (place.starts_with(fs::canonical(device.path(), ignored).string() + "/"))
        nodes.push_back(fs::path("/dev") / raw.path().filename());
    }
  }
  return nodes;
}

/// Where sound is recorded from.
std::vector<fs::path> sound_nodes() {
  std::vector<fs::path> nodes;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev/snd", ignored)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("pcm") && name.ends_with("c")) nodes.push_back(entry.path());
  }
  return nodes;
}

/// Who listens at a port of this machine, by the kernel's list.
std::optional<std::uint32_t> listener_of(std::uint16_t port, bool is_udp) {
  const auto names =
      is_udp ? std::array{"/proc/net/udp", "/proc/net/udp6"} : std::array{"/proc/net/tcp", "/proc/net/tcp6"};
  const std::string ending = fmt::format(":{:04X}", port);
  for (const char* const name : names) {
    std::ifstream in(name);
    for (std::string line; std::getline(in, line);) {
      std::istringstream words(line);
      std::string slot, local, remote, state, queues, timer, retries;
      std::uint32_t user_id = 0;
      if (!(words >> slot >> local >> remote >> state >> queues >> timer >> retries >> user_id)) continue;
      const bool listens = state == (is_udp ? "07" : "0A");  // include/net/tcp_states.h
      if (listens && local.ends_with(ending)) return user_id;
    }
  }
  return std::nullopt;
}

ListenFacts listen_facts(const std::string& what, const std::string& address, const Rehearsal& rehearsal,
                         std::optional<bool> is_shared_udp = std::nullopt) {
  ListenFacts facts{.what = what, .address = address};
  facts.is_own = std::ranges::find(rehearsal.own_addresses, address) != rehearsal.own_addresses.end();
  const auto parsed = parse_address(address.starts_with(':') ? "0.0.0.0" + address : address);
  if (!parsed || facts.is_own) return facts;
  facts.port = parsed->port;
  if (std::ifstream in("/proc/sys/net/ipv4/ip_unprivileged_port_start"); in) in >> facts.first_unprivileged_port;
  bool is_in_use = false;
  facts.trouble = is_shared_udp ? udp_trouble(address, *is_shared_udp) : listen_trouble(address, is_in_use);
  if (!facts.trouble.empty()) facts.listener = listener_of(facts.port, is_shared_udp.has_value());
  return facts;
}

std::vector<ListenFacts> listen_facts(const Rehearsal& rehearsal) {
  std::vector<ListenFacts> all = {listen_facts("[stream] listen", rehearsal.config.stream.listen, rehearsal)};
  if (const std::string& page = rehearsal.config.http.listen; !page.empty())
    all.push_back(listen_facts("[http] listen", page, rehearsal));
  for (const settings::SensorConfig& sensor : rehearsal.config.sensors) {
    for (const DeviceFacts& device : named_devices(sensor)) {
      const std::string what = "sensor " + sensor.name;
      if (device.kind == EndpointKind::kTcpPort) all.push_back(listen_facts(what, device.name, rehearsal));
      if (device.kind == EndpointKind::kUdpPort)
        all.push_back(listen_facts(what, device.name, rehearsal, device.is_shared));
    }
  }
  return all;
}

/// The sensor's devices that are found by what is plugged in. One of several that would do is enough.
std::vector<PathFacts> plugged_paths(const settings::SensorConfig& sensor, const DeviceFacts& device,
                                     const std::optional<std::span<const sensors::DeviceFinding>>& plugged) {
  std::vector<fs::path> nodes;
  if (device.kind == EndpointKind::kSoundCard) nodes = sound_nodes();
  if (is_usb(device.kind)) {
    if (!plugged) return {};
    for (const sensors::DeviceFinding& found : *plugged) {
      if (!is_chosen(sensor, found)) continue;
      for (fs::path& node : usb_nodes(found.device.what, device.kind == EndpointKind::kHid))
        nodes.push_back(std::move(node));
    }
  }
  if (nodes.empty()) nodes.emplace_back(device.name);  // nothing that is there
  std::vector<PathFacts> all;
  all.reserve(nodes.size());
  for (const fs::path& node : nodes)
    all.push_back({.what = "sensor " + sensor.name, .use = PathUse::kDevice, .node = {.path = node}});
  return all;
}

void add_findings(std::vector<Finding>& all, std::vector<Finding> more) {
  for (Finding& finding : more) {
    if (std::ranges::find(all, finding) == all.end()) all.push_back(std::move(finding));
  }
}

/// The programs of a unit: the words of its command that are paths of programs, also those that the first one starts.
void rehearse_programs(std::vector<Finding>& all, const ServiceUnit& unit) {
  for (const std::string& word : unit.command) {
    const bool is_program = word.starts_with("/usr/bin/") || word.starts_with("/usr/lib/") ||
                            (&word == &unit.command.front() && word.starts_with('/'));
    if (!is_program) continue;
    ProgramFacts program{.path = word, .is_there = access(word.c_str(), X_OK) == 0};
    const bool is_ours = fs::path(word).filename().string().starts_with("yuragi");
    if (program.is_there && is_ours) {
      if (const auto output = program_output({word, "--version"}, kProgramTimeout)) {
        program.exit_code = output->exit_code;
        program.text = output->text;
      }
    }
    add_findings(all, judge(program, unit));
  }
}

bool is_enabled(const std::string& prefix) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/etc/systemd/system/multi-user.target.wants", ignored)) {
    if (entry.path().filename().string().starts_with(prefix)) return true;
  }
  return false;
}

/// The viewer's X server, and the graphics that it draws by.
void rehearse_viewer(std::vector<Finding>& all) {
  const auto viewer = installed_unit("yuragi-viewer@.service");
  if (!viewer || !is_enabled("yuragi-viewer@")) {
    all.push_back({Verdict::kOk, "service", "no wall starts at boot: yuragi-viewer@.service is not enabled", {}});
    return;
  }
  add_findings(all, judge(*viewer));
  rehearse_programs(all, *viewer);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev/dri", ignored)) {
    if (entry.is_directory(ignored)) continue;
    PathFacts path{.what = "the wall's graphics", .use = PathUse::kDevice, .node = {.path = entry.path()}};
    look_at(path);
    add_findings(all, judge(path, *viewer));
  }
}

/// As `yuragi-viewer --list-monitors` shows them, "0  HDMI-1  1920 x ..."; nullopt: there is no display to ask.
std::optional<std::vector<std::string>> present_monitors() {
  const auto output = program_output({"yuragi-viewer", "--list-monitors"}, kProgramTimeout);
  if (!output || output->exit_code != 0) return std::nullopt;
  std::vector<std::string> names;
  std::istringstream lines(output->text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find("  ");
    const std::size_t end = line.find("  ", begin + 2);
    if (begin != std::string::npos && end != std::string::npos)
      names.push_back(line.substr(begin + 2, end - begin - 2));
  }
  return names;
}

void rehearse_monitors(std::vector<Finding>& all, const settings::Config& config) {
  std::optional<std::vector<std::string>> present;
  bool is_asked = false;
  for (const output::Table& table : config.outputs) {
    for (const output::Window& window : table.output.windows) {
      if (window.monitor.empty()) continue;
      if (!is_asked) present = present_monitors();
      is_asked = true;
      add_findings(all, judge(MonitorFacts{table.output.name, window.monitor, present}));
    }
  }
}

}  // namespace

std::vector<PathFacts> named_paths(const Rehearsal& rehearsal) {
  const settings::Config& config = rehearsal.config;
  std::vector<PathFacts> all;
  const auto add = [&](std::string what, const fs::path& path, PathUse use, bool is_optional = false) {
    fs::path whole = (rehearsal.unit.working_folder / path).lexically_normal();
    if (!whole.has_filename()) whole = whole.parent_path();  // "/var/lib/yuragi/"
    all.push_back({.what = std::move(what), .use = use, .is_optional = is_optional, .node = {.path = whole}});
  };
  const fs::path folder = rehearsal.config_file.parent_path();
  if (!rehearsal.config_file.empty()) add("configuration", rehearsal.config_file, PathUse::kRead);
  if (!config.http.token_file.empty()) add("[http] token_file", config.http.token_file, PathUse::kReadSecret);
  if (!config.http.certificate.empty()) {
    add("[http] certificate", config.http.certificate, PathUse::kRead);
    add("[http] key", config.http.key, PathUse::kReadSecret);
  }
  if (config.recording.file) {
    add("[recording] file", config.recording.file->parent_path(), PathUse::kWriteFolder);
    add("[recording] file", *config.recording.file, PathUse::kWriteFile, true);
  }
  if (!config.shaping.site_file.empty())
    add("[shaping] site_file", config.shaping.site_file.parent_path(), PathUse::kWriteFolder);
  if (config.wind.fallback) {
    add("[wind] fallback_recording", config.wind.fallback->recording.parent_path(), PathUse::kList);
    add("[wind] fallback_recording", config.wind.fallback->recording, PathUse::kRead, true);
  }
  if (const ParameterValues& look = config.by_name.at("look"); look.has("ground_image"))
    add("[look] ground_image", folder / look.text("ground_image"), PathUse::kRead);
  for (const settings::SceneConfig& scene : config.scenes) {
    if (scene.values.has("image"))
      add("scene " + scene.name + " image", folder / scene.values.text("image"), PathUse::kRead);
  }
  for (const settings::SensorConfig& sensor : config.sensors) {
    for (const Parameter& parameter : sensor.driver->parameters) {
      const auto found = sensor.values.all().find(parameter.name);
      const auto* text = found == sensor.values.all().end() ? nullptr : std::get_if<std::string>(&found->second);
      if (text == nullptr || text->empty()) continue;
      const std::string what = fmt::format("sensor {} {}", sensor.name, parameter.name);
      if (parameter.is_secret_file) add(what, *text, PathUse::kReadSecret);
      if (parameter.name == "ca_file" || (parameter.name == "profile" && text->find('/') != std::string::npos))
        add(what, *text, PathUse::kRead);
      if (parameter.name == "profile_dir") add(what, *text, PathUse::kList);
      if (parameter.name == "profile" && text->find('/') == std::string::npos && !rehearsal.unit.command.empty()) {
        add("profiles of " + what, fs::path(rehearsal.unit.command.front()).parent_path() / "../share/yuragi/profiles",
            PathUse::kList);
      }
    }
    for (const DeviceFacts& device : named_devices(sensor)) {
      const std::string what = "sensor " + sensor.name;
      if (device.kind == EndpointKind::kSerialPort) add(what, device.name, PathUse::kDevice);
      if (device.kind == EndpointKind::kFile) add(what, device.name, PathUse::kRead, true);
      if (is_usb(device.kind) || device.kind == EndpointKind::kSoundCard) {
        for (PathFacts& path : plugged_paths(sensor, device, rehearsal.plugged)) all.push_back(std::move(path));
      }
    }
  }
  return all;
}

void look_at(PathFacts& path) {
  const fs::path named = path.node.path;
  std::vector<fs::path> folders = folders_above(named);
  std::error_code error;
  if (const fs::path real = fs::canonical(named, error); !error && real != named) {
    for (fs::path& folder : folders_above(real)) {
      if (std::ranges::find(folders, folder) == folders.end()) folders.push_back(std::move(folder));
    }
  }
  path.folders.clear();
  for (const fs::path& folder : folders) {
    Node node = node_of(folder);
    if (!node.is_there) break;  // the rest is missing, too
    path.folders.push_back(std::move(node));
  }
  path.node = node_of(named);
}

std::vector<sensors::DeviceFinding> plugged_devices(const settings::Config& config) {
  std::vector<const drivers::sensor::DriverDescription*> drivers;
  for (const settings::SensorConfig& sensor : config.sensors) {
    const auto devices = named_devices(sensor);
    if (std::ranges::any_of(devices, is_usb, &DeviceFacts::kind) &&
        std::ranges::find(drivers, sensor.driver) == drivers.end())
      drivers.push_back(sensor.driver);
  }
  return sensors::find_devices(drivers);
}

std::vector<Finding> rehearse_configuration(const Rehearsal& rehearsal) {
  std::vector<Finding> all = judge(rehearsal.unit);
  for (PathFacts& path : named_paths(rehearsal)) {
    look_at(path);
    add_findings(all, judge(path, rehearsal.unit));
  }
  for (const ListenFacts& listen : listen_facts(rehearsal)) add_findings(all, judge(listen, rehearsal.unit));
  return all;
}

std::vector<std::string> next_start_warnings(const settings::Config& running, const settings::Config& next,
                                             const std::string& config_file) {
  Rehearsal rehearsal{.config = next, .config_file = config_file, .unit = this_process()};
  if (auto unit = installed_unit(kServiceUnit);
      unit && std::ranges::find(unit->command, config_file) != unit->command.end()) {
    rehearsal.unit = std::move(*unit);
  }
  rehearsal.own_addresses = {running.stream.listen, running.http.listen};
  for (const settings::SensorConfig& sensor : running.sensors) {
    for (const DeviceFacts& device : named_devices(sensor)) rehearsal.own_addresses.push_back(device.name);
  }
  std::vector<std::string> warnings;
  for (const Finding& finding : rehearse_configuration(rehearsal))
    warnings.push_back(fmt::format("at the next start: {}; fix: {}", finding.text, finding.remedy));
  return warnings;
}

std::vector<Finding> rehearse(const Rehearsal& rehearsal) {
  std::vector<Finding> all = rehearse_configuration(rehearsal);
  rehearse_programs(all, rehearsal.unit);
  rehearse_viewer(all);
  rehearse_monitors(all, rehearsal.config);
  if (gravest(all) == Verdict::kOk) {
    all.push_back({Verdict::kOk,
                   "service",
                   fmt::format("{} will find what it needs, as the user {}", rehearsal.unit.name, rehearsal.unit.user),
                   {}});
  }
  return all;
}

}  // namespace yuragi::daemon::tools::doctor
