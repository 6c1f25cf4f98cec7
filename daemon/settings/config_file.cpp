#include "daemon/settings/config_file.hpp"

#include <cstdlib>
#include <fstream>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include "daemon/settings/config.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::settings {
namespace {

Failure not_written(const std::string& message) {
  return {message, FailureKind::kCannotCreate};
}

/// Writes a file beside another, with the same owner and permissions.
Result<void, Failure> write_like(const std::filesystem::path& model, const std::filesystem::path& file,
                                 std::string_view text) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  struct stat status {};
  if (stat(model.c_str(), &status) == 0) {
    chmod(file.c_str(), status.st_mode & 07777U);
    // Only root may change the owner; for others the file has the right owner already, in practice.
    [[maybe_unused]] const int given = chown(file.c_str(), status.st_uid, status.st_gid);
  }
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) {
    return not_written(file.string() +
                       ": cannot be written; check that its folder is writable and the disk is not full");
  }
  return {};
}

/// Returns true if a sensor can be constructed from its values. That may fail here: this may be another machine than
/// the daemon's.
bool can_be_opened(const SensorConfig& sensor) {
  try {
    return open_sensor(sensor) != nullptr;
  } catch (const ConfigError&) {
    return false;
  }
}

/// Fails if the daemon would refuse the file, or a sensor that it accepted before.
Result<void, Failure> prove(const std::filesystem::path& file, const Config& before) {
  try {
    const Config config = load_config(file);
    for (std::size_t index = 0; index < config.sensors.size(); ++index) {
      if (can_be_opened(before.sensors.at(index))) open_sensor(config.sensors[index]);
    }
    return {};
  } catch (const ConfigError& error) {
    return Failure{std::string("the new configuration would have an error and was not written: ") + error.what()};
  }
}

}  // namespace

std::string absolute_path(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(file, error);
  return (error ? file : absolute).lexically_normal().string();
}

std::filesystem::path state_file(const std::filesystem::path& config_file, std::string_view name) {
  // systemd separates several folders by colons.
  const char* const folders = std::getenv("STATE_DIRECTORY");  // NOLINT(concurrency-mt-unsafe): nobody changes it
  const std::string_view first =
      folders == nullptr ? "" : std::string_view(folders).substr(0, std::string_view(folders).find(':'));
  if (!first.empty()) return std::filesystem::path(first) / name;
  if (config_file.empty()) return {};
  return config_file.string() + '.' + std::string(name);
}

Result<std::filesystem::path, Failure> replace_config(const std::filesystem::path& file, std::string_view old_text,
                                                      std::string_view new_text) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  if (error) return not_written(file.string() + ": " + error.message());

  platform::OutputFile output(real, true);
  if (const auto done = write_like(real, output.working_path(), new_text); !done) return done.error();
  const Config before = parse_config(old_text, file.string());
  if (const auto done = prove(output.working_path(), before); !done) return done.error();

  // The old text is on the disk before the new one replaces it.
  if (read_config_text(real) != old_text) {
    return not_written(file.string() +
                       ": was changed by another program in the meantime, and was not overwritten; start again");
  }
  const std::filesystem::path kept = real.string() + ".bak";
  platform::OutputFile backup(kept, true);
  if (const auto done = write_like(real, backup.working_path(), old_text); !done) return done.error();
  if (const auto done = backup.commit(); !done) return done.error();
  if (const auto done = output.commit(); !done) return done.error();
  return {boost::system::in_place_value, kept};
}

}  // namespace yuragi::daemon::settings
