#include "daemon/tools/support/support_bundle.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <system_error>

#include <date/date.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/settings/withhold_secrets.hpp"
#include "daemon/tools/support/recording_head.hpp"
#include "daemon/tools/support/redaction.hpp"
#include "engine/base/json_text.hpp"

namespace yuragi::daemon::tools::support {
namespace {

namespace fs = std::filesystem;

constexpr auto kProgramTimeout = std::chrono::seconds(10);
constexpr auto kPackTimeout = std::chrono::seconds(60);
constexpr auto kCountingPatience = std::chrono::seconds(10);
constexpr auto kJournalLines = "5000";
constexpr mode_t kOwnerAndGroup = 0640;

struct SystemProgram {
  const char* file;
  std::vector<std::string> command;
};

std::vector<SystemProgram> system_programs(bool with_host_name) {
  const auto journal = [&](const char* unit) {
    std::vector<std::string> command = {
        "journalctl", "--no-pager", "--output=short-iso-precise", "--lines", kJournalLines, "--unit", unit};
    if (!with_host_name) command.emplace_back("--no-hostname");
    return command;
  };
  std::vector<SystemProgram> all = {
      {"journal-yuragi.txt", journal("yuragi")},
      {"journal-yuragi-viewer.txt", journal("yuragi-viewer@*")},
      {"journal-yuragi-report.txt", journal("yuragi-report")},
      {"unit-yuragi.txt", {"systemctl", "--no-pager", "status", "--lines=0", "yuragi"}},
      {"kernel.txt", {"uname", "-srvm"}},
      {"uptime.txt", {"uptime"}},
      {"time.txt", {"timedatectl"}},
      {"disks.txt", {"df", "-h"}},
      {"memory.txt", {"free", "-h"}},
      {"usb.txt", {"lsusb"}},
      {"sound-cards.txt", {"arecord", "-l"}},
      {"serial-ports.txt", {"ls", "-l", "/dev/serial/by-id"}},
      {"packages.txt",
       {"dpkg-query", "--show", "yuragi", "libmodbus5", "libusb-1.0-0", "libhidapi-hidraw0", "libportaudio2",
        "libfftw3-double3", "libsqlite3-0", "libmosquitto1", "liblo7", "libglfw3", "gnuplot-nox", "mosquitto"}},
  };
  if (with_host_name) all.push_back({"host-name.txt", {"uname", "-n"}});
  return all;
}

std::string file_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The text of the configuration without its secrets. One that is not TOML is left out: where its secrets stand is not
/// known.
std::string configuration_text(const fs::path& file) {
  try {
    const auto withheld = settings::withhold_in_configuration(settings::read_config_text(file));
    return withheld ? withheld->text : "# Left out: it is not TOML, so its secrets cannot be found.\n";
  } catch (const settings::ConfigError& error) {
    return fmt::format("# It cannot be read: {}\n", error.what());
  }
}

constexpr const char* kReadme =
    "What a helper needs to know of a Yuragi installation, made by `yuragi support-bundle` at {}.\n"
    "Passwords and other secrets are replaced by \"(secret)\". Read it before you send it.\n"
    "\n"
    "configuration.toml       the configuration as it is written\n"
    "page.toml                what was set on the page: it is read after the configuration, and overrides its values\n"
    "configuration-full.toml  the result, with every default\n"
    "doctor.txt, doctor.json  what is wrong, and how to fix it\n"
    "status.txt, status.json  how the running daemon does\n"
    "journal-*.txt            the last lines of the log\n"
    "recording.txt            which sessions and how many readings the recording has\n"
    "recording-last-hour.csv  its last readings, if they were requested (--readings)\n"
    "others                   the system: kernel, packages, disks, devices\n";

void add_status(std::map<std::string, std::string>& files, const BundleRequest& request) {
  if (!request.examination.daemon) {
    files["status.txt"] = "no daemon replies\n";
    return;
  }
  files["status.txt"] = sensors::status_text(*request.examination.daemon);
  files["status.json"] = json_text(sensors::status_json(*request.examination.daemon), 2) + "\n";
}

void add_configuration(std::map<std::string, std::string>& files, const BundleRequest& request) {
  if (request.examination.config_file)
    files["configuration.toml"] = configuration_text(*request.examination.config_file);
  if (request.examination.config && !request.examination.config->page_file.empty())
    files["page.toml"] = configuration_text(request.examination.config->page_file);
  if (request.examination.config) {
    files["configuration-full.toml"] = settings::to_toml(*request.examination.config);
  } else {
    files["configuration-errors.txt"] = request.examination.config_error + "\n";
  }
}

void add_recording(std::map<std::string, std::string>& files, const BundleRequest& request) {
  if (!request.examination.config || !request.examination.config->recording.file) return;
  const fs::path& recording = *request.examination.config->recording.file;
  files["recording.txt"] = recording_head(recording, kCountingPatience);
  if (request.with_readings) files["recording-last-hour.csv"] = last_hour(recording);
}

}  // namespace

std::optional<doctor::ProgramOutput> run_program(std::vector<std::string> command) {
  return doctor::program_output(std::move(command), kProgramTimeout);
}

std::map<std::string, std::string> bundle_files(const BundleRequest& request) {
  std::map<std::string, std::string> files;
  files["README.txt"] =
      fmt::format(kReadme, date::format("%FT%TZ", std::chrono::floor<std::chrono::seconds>(request.now)));
  add_configuration(files, request);
  add_status(files, request);
  files["doctor.txt"] = doctor::findings_text(request.findings);
  files["doctor.json"] = json_text(doctor::findings_json(request.findings), 2) + "\n";
  files["os-release.txt"] = file_text("/etc/os-release");
  add_recording(files, request);
  for (const SystemProgram& program : system_programs(request.with_host_name)) {
    if (const auto said = request.run(program.command)) files[program.file] = said->text;
  }

  const Redaction redaction(request.examination.config ? known_secrets(*request.examination.config)
                                                       : std::vector<std::string>());
  for (auto& [name, text] : files) {
    if (name != "README.txt") text = redaction.apply(std::move(text));
  }
  return files;
}

Result<void, Failure> pack(const std::map<std::string, std::string>& files, const std::string& folder,
                           const fs::path& archive) {
  const auto failure = [&](const std::string& why) {
    return Failure{archive.string() + ": cannot be written: " + why, FailureKind::kCannotCreate};
  };
  std::string place = (fs::temp_directory_path() / "yuragi-support-XXXXXX").string();
  if (mkdtemp(place.data()) == nullptr) return failure(std::generic_category().message(errno));
  const std::unique_ptr<const std::string, void (*)(const std::string*)> remover(&place, [](const std::string* path) {
    std::error_code ignored;
    fs::remove_all(*path, ignored);
  });
  std::error_code error;
  fs::create_directory(fs::path(place) / folder, error);
  for (const auto& [name, text] : files) {
    std::ofstream out(fs::path(place) / folder / name, std::ios::binary);
    out << text;
    out.close();
    if (!out) return failure("no space left in " + place);
  }
  const int descriptor = open(archive.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kOwnerAndGroup);
  if (descriptor < 0) return failure(std::generic_category().message(errno));
  fchmod(descriptor, kOwnerAndGroup);  // independent of the umask
  close(descriptor);
  const auto said = doctor::program_output({"tar", "--create", "--gzip", "--file", fs::absolute(archive), "--directory",
                                            place, "--owner=0", "--group=0", folder},
                                           kPackTimeout);
  if (!said) return failure("tar is not installed; sudo apt install tar");
  if (said->exit_code != 0) return failure(said->text);
  return {};
}

}  // namespace yuragi::daemon::tools::support
