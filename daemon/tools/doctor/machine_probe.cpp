#include "daemon/tools/doctor/machine_probe.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "daemon/tools/doctor/local_port.hpp"
#include "daemon/tools/doctor/program_output.hpp"
#include "drivers/bus/serial_ports.hpp"
#include "engine/base/address.hpp"
#include "engine/base/version.hpp"

namespace yuragi::daemon::tools::doctor {
namespace {

namespace fs = std::filesystem;

constexpr double kSecondsPerDay = 86400.0;
constexpr auto kVersionTimeout = std::chrono::seconds(5);
constexpr std::uint64_t kFilesOfTheDaemon = 64;  // sockets, timers, the recording, libraries
constexpr std::uint64_t kFilesOfASensor = 8;
constexpr std::uint64_t kFilesOfThePage =
    224;  // its WebSockets (daemon/web/sockets.hpp) and newcomers (daemon/http/server.hpp)
constexpr std::size_t kMaxUserGroups = 256;

std::string user_name() {
  const passwd* const entry = getpwuid(geteuid());  // NOLINT(concurrency-mt-unsafe): no other thread runs
  return entry == nullptr ? std::to_string(geteuid()) : entry->pw_name;
}

bool is_set(const char* variable) {
  const char* const value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody changes it
  return value != nullptr && *value != '\0';
}

/// The first line of a file that begins with `key`, without it; empty if there is none.
std::string line_of(const fs::path& file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(key)) return line.substr(key.size());
  }
  return {};
}

/// The files of the libraries that this program has loaded and that read devices or write recordings.
std::vector<std::string> loaded_libraries() {
  constexpr std::array<std::string_view, 8> kNames = {"libmodbus", "libusb-1",   "libhidapi",    "libportaudio",
                                                      "libfftw3",  "libsqlite3", "libmosquitto", "liblo."};
  std::set<std::string> found;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    const std::string file = line.substr(line.rfind('/') == std::string::npos ? line.size() : line.rfind('/') + 1);
    if (std::ranges::any_of(kNames, [&](std::string_view name) { return file.starts_with(name); })) found.insert(file);
  }
  return {found.begin(), found.end()};
}

}  // namespace

GroupFacts probe_groups(std::vector<std::string> needed_groups) {
  GroupFacts facts{
      .user = user_name(), .is_root = geteuid() == 0, .groups = {}, .needed_groups = std::move(needed_groups)};
  std::array<gid_t, kMaxUserGroups> ids{};
  const int count = getgroups(static_cast<int>(ids.size()), ids.data());
  for (int i = 0; i < count; ++i) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): no other thread runs
    if (const group* const entry = getgrgid(ids.at(static_cast<std::size_t>(i))))
      facts.groups.emplace_back(entry->gr_name);
  }
  return facts;
}

ClockFacts probe_clock(const settings::Config& config) {
  ClockFacts facts{.now = std::chrono::system_clock::now()};
  facts.offset = platform::read_clock_offset(facts.now);
  facts.is_of_wall =
      std::ranges::any_of(config.outputs, [](const output::Table& table) { return table.output.delay_s.has_value(); });
  timex state{};
  if (adjtimex(&state) >= 0) facts.is_synchronised = (state.status & STA_UNSYNC) == 0;
  // Written by systemd-timesyncd, which also counts if the kernel does not report it (in a container).
  std::error_code ignored;
  if (fs::exists("/run/systemd/timesync/synchronized", ignored)) facts.is_synchronised = true;
  if (facts.offset.offset_s) facts.is_synchronised = true;
  return facts;
}

DiskFacts probe_disk(const settings::RecordingConfig& recording, double readings_per_s) {
  fs::path folder = recording.file->parent_path();
  if (folder.empty()) folder = ".";
  DiskFacts facts{.folder = folder.string(), .user = user_name()};
  std::error_code error;
  facts.is_there = fs::is_directory(folder, error);
  facts.is_writable = faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0;
  struct statvfs space {};
  if (statvfs(folder.c_str(), &space) == 0)
    facts.free_bytes = static_cast<double>(space.f_bavail) * static_cast<double>(space.f_frsize);
  facts.least_free_bytes = static_cast<double>(recording.least_free_bytes);
  facts.bytes_a_day = readings_per_s * kBytesPerReading * kSecondsPerDay;
  facts.is_bounded =
      (recording.is_daily || recording.most_file_bytes > 0) && (recording.keep_days > 0 || recording.most_bytes > 0);
  return facts;
}

PortFacts probe_port(const std::string& address, const std::string& daemon) {
  PortFacts facts{.address = address, .daemon = daemon};
  if (const auto parsed = parse_address(address)) facts.port = parsed->port;
  facts.trouble = listen_trouble(address, facts.is_in_use);
  return facts;
}

DisplayFacts probe_display() {
  DisplayFacts facts;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev/dri", ignored)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with("card") && !name.starts_with("renderD")) continue;
    facts.graphics.push_back(entry.path());
    const drivers::bus::AccessTrouble access = drivers::bus::access_trouble(entry.path());
    if (access.trouble.empty()) continue;
    facts.graphics_trouble = access.trouble;
    facts.graphics_remedy = access.remedy;
  }
  std::ranges::sort(facts.graphics);
  const bool has_x_socket = fs::directory_iterator("/tmp/.X11-unix", ignored) != fs::directory_iterator();
  facts.has_display = is_set("DISPLAY") || is_set("WAYLAND_DISPLAY") || has_x_socket;
  if (const auto said = program_output({"yuragi-viewer", "--version"}, kVersionTimeout); said && said->exit_code == 0)
    facts.viewer = said->text.substr(0, said->text.find('\n'));
  return facts;
}

VersionFacts probe_versions(const std::string& daemon, const std::optional<std::string>& viewer) {
  VersionFacts facts{.program = with_version("yuragi"), .version = kVersion, .viewer = viewer, .daemon = daemon};
  facts.libraries = loaded_libraries();
  utsname system{};
  if (uname(&system) == 0) facts.kernel = fmt::format("{} {} {}", system.sysname, system.release, system.machine);
  facts.system = line_of("/etc/os-release", "PRETTY_NAME=");
  std::erase(facts.system, '"');
  return facts;
}

LimitFacts probe_limits(const settings::Config& config) {
  LimitFacts facts;
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) == 0) {
    facts.open_files = files.rlim_cur;
    facts.most_open_files = files.rlim_max;
  }
  facts.needed_open_files = kFilesOfTheDaemon + config.stream.max_clients + kFilesOfASensor * config.sensors.size() +
                            (config.http.listen.empty() ? 0 : kFilesOfThePage);
  const std::string available_kib = line_of("/proc/meminfo", "MemAvailable:");
  if (!available_kib.empty()) facts.available_memory_bytes = 1024 * std::strtoull(available_kib.c_str(), nullptr, 10);
  return facts;
}

}  // namespace yuragi::daemon::tools::doctor
