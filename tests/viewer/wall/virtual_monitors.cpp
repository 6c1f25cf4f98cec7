#include "tests/viewer/wall/virtual_monitors.hpp"

#include <fstream>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/viewer/started_program.hpp"

namespace yuragi::viewer {
namespace {

constexpr const char* kConfiguration = R"(
Section "Device"
  Identifier "card"
  Driver "dummy"
  VideoRam 65536
EndSection
Section "Screen"
  Identifier "screen"
  Device "card"
  DefaultDepth 24
  SubSection "Display"
    Depth 24
    Virtual 2048 1024
    Modes "800x600" "640x480"
  EndSubSection
EndSection
)";

/// The command of an Xorg whose files are in this folder.
std::vector<std::string> xorg(const std::filesystem::path& folder) {
  const std::filesystem::path configuration = folder / "xorg.conf";
  std::ofstream(configuration) << kConfiguration;
  return {"Xorg",        "-config",  configuration.string(), "-logfile", (folder / "xorg.log").string(),
          "-novtswitch", "-sharevts"};
}

}  // namespace

VirtualMonitors::VirtualMonitors(const std::filesystem::path& folder) : XServer(xorg(folder)) {}

bool VirtualMonitors::arrange(std::vector<std::string> words) const {
  // The server looks at its outputs only when it is asked what there is.
  return xrandr(std::move(words)) && xrandr({"--query"});
}

bool VirtualMonitors::xrandr(std::vector<std::string> words) const {
  words.insert(words.begin(), "xrandr");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const pid_t child = start_program(std::move(words), environment(), &actions);
  posix_spawn_file_actions_destroy(&actions);
  int status = -1;
  return child != 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace yuragi::viewer
