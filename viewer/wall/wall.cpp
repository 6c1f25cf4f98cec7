#include "viewer/wall/wall.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "engine/base/result.hpp"
#include "viewer/wall/monitors.hpp"
#include "viewer/wall/wall_pass.hpp"
#include "viewer/wall/window_map.hpp"

namespace yuragi::viewer::wall {
namespace {

constexpr double kLookEvery_s = 1.0;  // a monitor's size can change without a word from GLFW
constexpr int kUsualRate_hz = 60;

/// Set by GLFW's callback, which cannot carry our data.
bool have_monitors_changed = false;

struct Window {
  output::Window settings;
  GLFWwindow* handle = nullptr;
  std::string monitor_name = {};        // finds it again, also if it was chosen by its number
  std::optional<Monitor> monitor = {};  // on which it is
  GLuint vertex_array = 0;              // goes with its context
};

std::string missing_text(const std::string& wanted) {
  const std::string what = wanted.empty() ? "there is no monitor" : "there is no monitor \"" + wanted + "\"";
  return "output.window.monitor: " + what + "; there are:\n" + monitors_text();
}

}  // namespace

struct Wall::State {
  State(GLFWwindow* first, output::Output of) : output(std::move(of)) {
    for (const output::Window& window : output.windows) {
      const auto monitor = monitor_named(window.monitor);
      if (!monitor) throw FailureError({missing_text(window.monitor), FailureKind::kUnavailable});
      windows.push_back({.settings = window, .monitor_name = monitor->name});
    }
    for (std::size_t i = 0; i < windows.size(); ++i) {
      windows[i].handle = i == 0 ? first : make_sharing(first);
      glfwSetInputMode(windows[i].handle, GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
      glfwMakeContextCurrent(windows[i].handle);
      glGenVertexArrays(1, &windows[i].vertex_array);
    }
    glfwMakeContextCurrent(first);
    pass.emplace();
    has_fences = epoxy_gl_version() >= 32 || epoxy_has_gl_extension("GL_ARB_sync");
    glfwSetMonitorCallback([](GLFWmonitor*, int) { have_monitors_changed = true; });
    place();
  }
  ~State() {
    glfwSetMonitorCallback(nullptr);
    for (const Window& window : windows) {
      if (window.handle != windows.front().handle) glfwDestroyWindow(window.handle);
    }
    glfwMakeContextCurrent(windows.front().handle);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Hidden; typed keys go to the first window.
  static GLFWwindow* make_sharing(GLFWwindow* first) {
    GLFWwindow* const made = glfwCreateWindow(64, 64, "Yuragi", nullptr, first);
    if (made == nullptr) {
      throw FailureError({"the graphics driver cannot draw one picture in several windows", FailureKind::kUnavailable});
    }
    glfwSetWindowUserPointer(made, glfwGetWindowUserPointer(first));
    const GLFWkeyfun when_typed = glfwSetKeyCallback(first, nullptr);
    glfwSetKeyCallback(first, when_typed);
    glfwSetKeyCallback(made, when_typed);
    return made;
  }

  /// Each window on its monitor, or hidden.
  void place() {
    bool is_first = true;
    for (Window& window : windows) {
      const auto monitor = monitor_named(window.monitor_name);
      if (monitor != window.monitor) move(window, monitor);
      if (!window.monitor) continue;
      // Only one window waits for the display: waiting for one after the other would halve the rate.
      glfwMakeContextCurrent(window.handle);
      glfwSwapInterval(is_first ? output.refreshes : 0);
      is_first = false;
    }
    glfwMakeContextCurrent(windows.front().handle);
    std::vector<output::Size> sizes;
    for (const Window& window : windows) sizes.push_back(window.monitor ? window.monitor->size : output::Size{});
    const output::Size wanted = wall::picture_size(output, sizes);
    if (wanted.width_px > 0 && wanted.height_px > 0) size = wanted;
  }

  static void move(Window& window, const std::optional<Monitor>& monitor) {
    if (monitor) {
      if (window.monitor != std::nullopt) glfwSetWindowMonitor(window.handle, nullptr, 0, 0, 64, 64, GLFW_DONT_CARE);
      glfwSetWindowMonitor(window.handle, monitor->handle, 0, 0, monitor->size.width_px, monitor->size.height_px,
                           monitor->refresh_rate_hz);
      glfwShowWindow(window.handle);
      std::fprintf(stderr, "yuragi-viewer: monitor %s, %d x %d\n", monitor->name.c_str(), monitor->size.width_px,
                   monitor->size.height_px);
    } else {
      glfwHideWindow(window.handle);
      std::fprintf(stderr, "yuragi-viewer: monitor %s is gone\n", window.monitor_name.c_str());
    }
    window.monitor = monitor;
  }

  output::Output output;
  std::vector<Window> windows;
  std::optional<Pass> pass;
  bool has_fences = false;  // a context can wait for another on the GPU: from OpenGL 3.2 on
  output::Size size{.width_px = 1280, .height_px = 720};
  double looked_s = -std::numeric_limits<double>::infinity();
};

Wall::Wall(GLFWwindow* first, const output::Output& output) : state_(std::make_unique<State>(first, output)) {}
Wall::~Wall() = default;

void Wall::follow_monitors(double now_s) {
  if (!have_monitors_changed && now_s - state_->looked_s < kLookEvery_s) return;
  have_monitors_changed = false;
  state_->looked_s = now_s;
  state_->place();
}

bool Wall::is_dark() const {
  return std::ranges::none_of(state_->windows, [](const Window& window) { return window.monitor.has_value(); });
}

output::Size Wall::picture_size() const {
  return state_->size;
}

double Wall::picture_interval_s() const {
  int rate_hz = 0;
  for (const Window& window : state_->windows) {
    if (rate_hz == 0 && window.monitor) rate_hz = window.monitor->refresh_rate_hz;
  }
  return static_cast<double>(state_->output.refreshes) / (rate_hz > 0 ? rate_hz : kUsualRate_hz);
}

void Wall::show(const gl::RenderTarget& target, bool is_marked) {
  Pass& pass = *state_->pass;
  pass.take(target);
  const GLsync is_taken = state_->has_fences ? glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0) : nullptr;
  if (is_taken != nullptr) {
    glFlush();
  } else {
    glFinish();
  }
  // All are drawn before one is shown, so that they change together.
  for (const Window& window : state_->windows) {
    if (!window.monitor) continue;
    glfwMakeContextCurrent(window.handle);
    if (is_taken != nullptr) glWaitSync(is_taken, 0, GL_TIMEOUT_IGNORED);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    output::Size size;
    glfwGetFramebufferSize(window.handle, &size.width_px, &size.height_px);
    pass.draw(window.settings, size, window.vertex_array, is_marked);
  }
  for (const Window& window : state_->windows) {
    if (!window.monitor) continue;
    glfwMakeContextCurrent(window.handle);
    glfwSwapBuffers(window.handle);
  }
  glfwMakeContextCurrent(state_->windows.front().handle);
  if (is_taken != nullptr) glDeleteSync(is_taken);
}

}  // namespace yuragi::viewer::wall
