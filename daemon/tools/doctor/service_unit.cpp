#include "daemon/tools/doctor/service_unit.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <system_error>

#include <grp.h>
#include <pwd.h>
#include <unistd.h>

#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::doctor {
namespace {

namespace fs = std::filesystem;

/// Where systemd looks for units, the first one first.
constexpr std::array<std::string_view, 4> kUnitFolders = {"/etc/systemd/system", "/run/systemd/system",
                                                          "/usr/local/lib/systemd/system", "/lib/systemd/system"};
constexpr int kMaxGroups = 256;

std::string trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1));
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

bool is_true(const std::string& value) {
  return value == "yes" || value == "true" || value == "on" || value == "1";
}

/// An empty value empties the list, as systemd has it.
void extend(std::vector<std::string>& list, const std::string& value, const std::string& prefix = {}) {
  if (value.empty()) return list.clear();
  for (const std::string& word : words_of(value)) list.push_back(prefix + word);
}

/// A line of [Service].
void apply(ServiceUnit& unit, const std::string& key, const std::string& value) {
  constexpr std::string_view kLowPorts = "CAP_NET_BIND_SERVICE";
  if (key == "User") unit.user = value.empty() ? "root" : value;
  if (key == "Group") unit.group = value;
  if (key == "SupplementaryGroups") extend(unit.groups, value);
  if (key == "StateDirectory") extend(unit.folders, value, "/var/lib/");
  if (key == "CacheDirectory") extend(unit.folders, value, "/var/cache/");
  if (key == "LogsDirectory") extend(unit.folders, value, "/var/log/");
  if (key == "RuntimeDirectory") extend(unit.folders, value, "/run/");
  if (key == "ReadWritePaths") extend(unit.writable, value);
  if (key == "WorkingDirectory") unit.working_folder = value;
  if (key == "ExecStart") extend(unit.command, value);
  if (key == "ProtectHome") unit.hides_home = is_true(value) || value == "tmpfs";
  if (key == "PrivateTmp") unit.has_own_tmp = is_true(value);
  if (key == "ProtectSystem")
    unit.protects_system = is_true(value) || value == "full" || value == "strict" ? value : "";
  if (key == "DevicePolicy") unit.has_closed_devices = value == "closed" || value == "strict";
  if (key == "DeviceAllow") {
    if (value.empty()) unit.devices.clear();
    if (const auto words = words_of(value); !words.empty()) unit.devices.push_back(words.front());
  }
  if (key == "AmbientCapabilities") unit.may_use_low_ports = value.find(kLowPorts) != std::string::npos;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// NOLINTBEGIN(concurrency-mt-unsafe): the names are looked up by one thread

std::optional<std::uint32_t> group_id(const std::string& name) {
  const group* const entry = getgrnam(name.c_str());
  return entry == nullptr ? std::nullopt : std::optional<std::uint32_t>(entry->gr_gid);
}

void look_up_ids(ServiceUnit& unit) {
  const passwd* const entry = getpwnam(unit.user.c_str());
  if (entry == nullptr) return;
  unit.user_id = entry->pw_uid;
  const gid_t own = unit.group.empty() ? entry->pw_gid : group_id(unit.group).value_or(entry->pw_gid);
  std::array<gid_t, kMaxGroups> ids{};
  int count = kMaxGroups;
  if (getgrouplist(unit.user.c_str(), own, ids.data(), &count) < 0) count = kMaxGroups;
  unit.group_ids.assign(ids.begin(), ids.begin() + count);
  for (const std::string& name : unit.groups) {
    if (const auto id = group_id(name)) unit.group_ids.push_back(*id);
  }
}

// NOLINTEND(concurrency-mt-unsafe)

}  // namespace

ServiceUnit parse_unit(std::string name, std::string_view text) {
  ServiceUnit unit;
  unit.name = std::move(name);
  std::istringstream in{std::string(text)};
  std::string section;
  for (std::string line; std::getline(in, line);) {
    for (std::string more; line.ends_with('\\') && std::getline(in, more);)
      line.replace(line.size() - 1, 1, " " + more);
    line = trimmed(line);
    if (line.empty() || line.starts_with('#') || line.starts_with(';')) continue;
    if (line.starts_with('[')) {
      section = line;
      continue;
    }
    const std::size_t equals = line.find('=');
    if (section != "[Service]" || equals == std::string::npos) continue;
    apply(unit, trimmed(std::string_view(line).substr(0, equals)), trimmed(std::string_view(line).substr(equals + 1)));
  }
  return unit;
}

std::optional<ServiceUnit> installed_unit(const std::string& name) {
  std::error_code ignored;
  const auto folder = std::ranges::find_if(
      kUnitFolders, [&](std::string_view one) { return fs::is_regular_file(fs::path(one) / name, ignored); });
  if (folder == kUnitFolders.end()) return std::nullopt;
  std::string text = text_of(fs::path(*folder) / name);
  // Of drop-ins that have the same name the first folder's counts.
  std::set<std::string> drop_ins;
  for (const std::string_view one : kUnitFolders) {
    for (const auto& entry : fs::directory_iterator(fs::path(one) / (name + ".d"), ignored)) {
      if (entry.path().extension() == ".conf") drop_ins.insert(entry.path().filename());
    }
  }
  for (const std::string& drop_in : drop_ins) {
    const auto owner = std::ranges::find_if(kUnitFolders, [&](std::string_view one) {
      return fs::exists(fs::path(one) / (name + ".d") / drop_in, ignored);
    });
    if (owner != kUnitFolders.end()) text += "\n" + text_of(fs::path(*owner) / (name + ".d") / drop_in);
  }
  ServiceUnit unit = parse_unit(name, text);
  look_up_ids(unit);
  return unit;
}

ServiceUnit unit_of_file(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored) || access(file.c_str(), R_OK) != 0) {
    throw FailureError({file.string() + ": the unit cannot be read", FailureKind::kNoInput});
  }
  ServiceUnit unit = parse_unit(file.filename(), text_of(file));
  look_up_ids(unit);
  return unit;
}

ServiceUnit this_process() {
  ServiceUnit unit;
  unit.user_id = geteuid();
  const passwd* const entry = getpwuid(geteuid());  // NOLINT(concurrency-mt-unsafe): as above
  unit.user = entry == nullptr ? std::to_string(geteuid()) : entry->pw_name;
  std::array<gid_t, kMaxGroups> ids{};
  const int count = getgroups(kMaxGroups, ids.data());
  unit.group_ids.assign(ids.begin(), ids.begin() + std::max(count, 0));
  unit.group_ids.push_back(getegid());
  std::error_code ignored;
  unit.working_folder = fs::current_path(ignored);
  return unit;
}

}  // namespace yuragi::daemon::tools::doctor
