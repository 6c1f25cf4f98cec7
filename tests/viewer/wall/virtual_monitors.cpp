#include "tests/viewer/wall/virtual_monitors.hpp"

#include <array>
#include <csignal>
#include <fstream>
#include <memory>

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/viewer/virtual_screen.hpp"

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

using OpenDisplay = std::unique_ptr<Display, int (*)(Display*)>;

}  // namespace

VirtualMonitors::VirtualMonitors(const std::filesystem::path& folder) : folder_(folder) {
  constexpr int kNumberFd = 9;
  const std::filesystem::path configuration = folder / "xorg.conf";
  std::ofstream(configuration) << kConfiguration;
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], kNumberFd);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  server_ =
      start_program({"Xorg", "-displayfd", std::to_string(kNumberFd), "-config", configuration.string(), "-logfile",
                     (folder / "xorg.log").string(), "-noreset", "-novtswitch", "-sharevts", "-nolisten", "tcp"},
                    environment_without_screen(), &actions);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  char letter = 0;
  while (::read(ends[0], &letter, 1) == 1 && letter != '\n') number_ += letter;
  ::close(ends[0]);
  if (!is_there()) return;

  const OpenDisplay display(XOpenDisplay((":" + number_).c_str()), XCloseDisplay);
  if (!display) return;
  XSetWindowBackground(display.get(), DefaultRootWindow(display.get()), WhitePixel(display.get(), 0));
  XClearWindow(display.get(), DefaultRootWindow(display.get()));
}

VirtualMonitors::~VirtualMonitors() {
  if (server_ == 0) return;
  ::kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
}

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

std::vector<std::string> VirtualMonitors::environment() const {
  std::vector<std::string> environment = environment_without_screen();
  environment.push_back("DISPLAY=:" + number_);
  return environment;
}

VirtualMonitors::Pixels VirtualMonitors::pixels() const {
  const OpenDisplay display(XOpenDisplay((":" + number_).c_str()), XCloseDisplay);
  if (!display) return {};
  const Window root = DefaultRootWindow(display.get());
  XWindowAttributes size;
  XGetWindowAttributes(display.get(), root, &size);
  XImage* const image = XGetImage(display.get(), root, 0, 0, static_cast<unsigned>(size.width),
                                  static_cast<unsigned>(size.height), AllPlanes, ZPixmap);
  if (image == nullptr) return {};
  Pixels pixels{.width_px = size.width, .height_px = size.height, .rows = {}};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      pixels.rows.push_back(static_cast<std::uint32_t>(XGetPixel(image, x, y)) & 0xFFFFFFU);
    }
  }
  XDestroyImage(image);
  return pixels;
}

}  // namespace yuragi::viewer
