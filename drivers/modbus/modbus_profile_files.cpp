// Where profiles are searched for.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <vector>

#include "drivers/modbus/modbus_profile.hpp"
#include "engine/tables/parse_toml.hpp"

namespace yuragi::drivers::modbus {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> profile_directories(const std::string& first) {
  std::vector<fs::path> directories;
  if (!first.empty()) directories.emplace_back(first);
  // Read during set-up, when no thread changes the environment.
  const char* const set = std::getenv("YURAGI_PROFILE_DIR");  // NOLINT(concurrency-mt-unsafe)
  if (set != nullptr && *set != '\0') {
    directories.emplace_back(set);
  }
  std::error_code ignored;
  const fs::path executable = fs::read_symlink("/proc/self/exe", ignored);
  directories.push_back(executable.parent_path() / "../share/yuragi/profiles");
#ifdef YURAGI_PROFILE_SOURCE_DIR
  directories.emplace_back(YURAGI_PROFILE_SOURCE_DIR);
#endif
  return directories;
}

/// Their names without ".toml".
std::set<std::string> names_in(const std::vector<fs::path>& directories) {
  std::set<std::string> names;
  for (const fs::path& directory : directories) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(directory, ignored)) {
      if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
    }
  }
  return names;
}

/// "renke-rs-fsjt-n01, ..." in alphabetical order.
std::string known_names(const std::vector<fs::path>& directories) {
  std::string list;
  for (const std::string& name : names_in(directories)) list.append(list.empty() ? "" : ", ").append(name);
  return list.empty() ? "none" : list;
}

Profile read_profile(const fs::path& path) {
  std::error_code ignored;
  std::ifstream in;
  if (fs::is_regular_file(path, ignored)) in.open(path, std::ios::binary);  // a pipe would be waited for
  const std::string text = tables::toml_text(in);
  if (!in.is_open() || in.bad()) {
    throw std::runtime_error(path.string() +
                             ": the profile cannot be read; check that it is a file, and its permissions");
  }
  return parse_modbus_profile(text, path.string());
}

}  // namespace

std::vector<std::string> modbus_profile_names(const std::string& directory) {
  const std::set<std::string> names = names_in(profile_directories(directory));
  return {names.begin(), names.end()};
}

Profile load_modbus_profile(const std::string& name, const std::string& directory) {
  if (name.find('/') != std::string::npos || name.ends_with(".toml")) return read_profile(name);

  const std::vector<fs::path> directories = profile_directories(directory);
  for (const fs::path& candidate : directories) {
    std::error_code ignored;
    const fs::path path = candidate / (name + ".toml");
    if (!name.empty() && fs::is_regular_file(path, ignored)) return read_profile(path);
  }
  throw std::runtime_error("no Modbus profile named \"" + name + "\"; known: " + known_names(directories) +
                           "; or give the path of a .toml file");
}

}  // namespace yuragi::drivers::modbus
