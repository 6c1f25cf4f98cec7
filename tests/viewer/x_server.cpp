#include "tests/viewer/x_server.hpp"

#include <array>
#include <csignal>

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/viewer/started_program.hpp"

namespace yuragi::viewer {

struct XServer::Connection {
  explicit Connection(Display* opened) : to(opened) {}
  ~Connection() { XCloseDisplay(to); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  Display* to;
};

XServer::XServer(std::vector<std::string> words) {
  constexpr int kNumberFd = 9;
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
  // With -terminate it ends with its last client: our own connection keeps it.
  words.insert(words.end(), {"-displayfd", std::to_string(kNumberFd), "-terminate", "-nolisten", "tcp"});
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], kNumberFd);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  server_ = start_program(std::move(words), environment_without_screen(), &actions);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  // It says its number when it is ready, and a line's end.
  char letter = 0;
  while (::read(ends[0], &letter, 1) == 1 && letter != '\n') number_ += letter;
  ::close(ends[0]);

  Display* const opened = number_.empty() ? nullptr : XOpenDisplay((":" + number_).c_str());
  if (opened == nullptr) return;
  display_ = std::make_unique<Connection>(opened);
  XSetWindowBackground(opened, DefaultRootWindow(opened), WhitePixel(opened, 0));
  XClearWindow(opened, DefaultRootWindow(opened));
  XSync(opened, False);
}

XServer::~XServer() {
  display_.reset();
  if (server_ == 0) return;
  ::kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
}

std::vector<std::string> XServer::environment() const {
  std::vector<std::string> environment = environment_without_screen();
  environment.push_back("DISPLAY=:" + number_);
  return environment;
}

ScreenPixels XServer::pixels() const {
  const Window root = DefaultRootWindow(display_->to);
  XWindowAttributes size;
  XGetWindowAttributes(display_->to, root, &size);
  XImage* const image = XGetImage(display_->to, root, 0, 0, static_cast<unsigned>(size.width),
                                  static_cast<unsigned>(size.height), AllPlanes, ZPixmap);
  if (image == nullptr) return {};
  ScreenPixels pixels{.width_px = size.width, .height_px = size.height, .rows = {}};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      pixels.rows.push_back(static_cast<std::uint32_t>(XGetPixel(image, x, y)) & 0xFFFFFFU);
    }
  }
  XDestroyImage(image);
  return pixels;
}

bool XServer::type(const std::string& key) const {
  const KeyCode code = XKeysymToKeycode(display_->to, XStringToKeysym(key.c_str()));
  if (code == 0) return false;
  XTestFakeKeyEvent(display_->to, code, True, CurrentTime);
  XTestFakeKeyEvent(display_->to, code, False, CurrentTime);
  XSync(display_->to, False);
  return true;
}

void XServer::point(int x, int y) const {
  XTestFakeMotionEvent(display_->to, -1, x, y, CurrentTime);
  XSync(display_->to, False);
}

void XServer::hold_button(bool is_down) const {
  XTestFakeButtonEvent(display_->to, Button1, is_down ? True : False, CurrentTime);
  XSync(display_->to, False);
}

}  // namespace yuragi::viewer
