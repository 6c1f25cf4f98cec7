#include "viewer/app/window.hpp"

#define GLFW_INCLUDE_NONE
#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include <GLFW/glfw3.h>

#include "viewer/gl/driver.hpp"
#include "viewer/picture/viewer_exit.hpp"
#include "viewer/wall/monitors.hpp"

namespace yuragi::viewer::app {
namespace {

std::string& last_glfw_error() {
  static std::string text;
  return text;
}

[[noreturn]] void throw_unavailable(const std::string& what) {
  throw picture::ViewerExit(EX_UNAVAILABLE,
                            what + " (" + last_glfw_error() +
                                ").\nA picture in a file needs no screen: yuragi-viewer --screenshot picture.png");
}

void begin_glfw() {
  glfwSetErrorCallback([](int, const char* text) { last_glfw_error() = text; });
  if (glfwInit() != GLFW_TRUE) throw_unavailable("there is no display to open a window on");
}

/// Sets hints for the windows that are created from now on: those of a wall share the first one's context.
void ask_for(const gl::Version& version) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, version.major);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, version.minor);
  glfwWindowHint(GLFW_OPENGL_PROFILE, version.is_core() ? GLFW_OPENGL_CORE_PROFILE : GLFW_OPENGL_ANY_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
}

/// Returns a window whose context, now current, fulfils the requirements; null if there is none.
GLFWwindow* create_with_newest_gl(const WindowOptions& options) {
  for (const gl::Version& version : gl::kVersionsToAskFor) {
    ask_for(version);
    GLFWwindow* const made = glfwCreateWindow(options.width_px, options.height_px, "Yuragi", nullptr, nullptr);
    if (made == nullptr) continue;
    glfwMakeContextCurrent(made);
    if (gl::is_enough(gl::current_driver())) return made;
    glfwDestroyWindow(made);
  }
  return nullptr;
}

/// Also ends GLFW.
[[noreturn]] void throw_without_gl() {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  std::optional<gl::Driver> driver;  // the driver of a context of any version
  if (GLFWwindow* const made = glfwCreateWindow(64, 64, "Yuragi", nullptr, nullptr); made != nullptr) {
    glfwMakeContextCurrent(made);
    driver = gl::current_driver();
  }
  glfwTerminate();
  if (driver) throw picture::ViewerExit(EX_UNAVAILABLE, gl::too_old_text(*driver));
  throw_unavailable("this display has no OpenGL");
}

}  // namespace

struct Window::State {
  explicit State(const WindowOptions& options) {
    begin_glfw();
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);  // gl::is_context_lost()
#ifdef YURAGI_GL_DEBUG
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
#endif
    if (options.is_hidden) {
      // For this window, and for those that share its context. A wall is shown even if another window has the keyboard.
      for (const int hint : {GLFW_VISIBLE, GLFW_DECORATED, GLFW_AUTO_ICONIFY}) glfwWindowHint(hint, GLFW_FALSE);
    }
    is_placed_by_wall = options.is_hidden;
    window = create_with_newest_gl(options);
    if (window == nullptr) throw_without_gl();
    glfwSwapInterval(1);
    monitor = options.monitor;
    if (options.is_fullscreen) toggle_fullscreen();

    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, [](GLFWwindow* on, int key, int, int action, int) {
      if (action == GLFW_PRESS) state_of(on).press(key);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* on, double x, double y) { state_of(on).move(x, y); });
    glfwSetScrollCallback(window, [](GLFWwindow* on, double, double notches) {
      if (!state_of(on).is_mouse_taken) state_of(on).input.zoom_notches += notches;
    });
  }
  ~State() {
    glfwDestroyWindow(window);
    glfwTerminate();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  static State& state_of(GLFWwindow* on) {
    return *static_cast<State*>(glfwGetWindowUserPointer(on));
  }

  void press(int key) {
    if (are_keys_taken) return;
    if (const auto found = key_of(key)) input.keys.push_back(*found);
  }

  void move(double x, double y) {
    int width = 0;
    int height = 1;
    glfwGetWindowSize(window, &width, &height);
    const double right = (x - cursor_x) / std::max(1, height);
    const double down = (y - cursor_y) / std::max(1, height);
    cursor_x = x;
    cursor_y = y;
    if (is_mouse_taken) return;
    const auto is_down = [&](int button) { return glfwGetMouseButton(window, button) == GLFW_PRESS; };
    if (is_down(GLFW_MOUSE_BUTTON_LEFT)) {
      input.orbit_right += right;
      input.orbit_down += down;
    } else if (is_down(GLFW_MOUSE_BUTTON_RIGHT) || is_down(GLFW_MOUSE_BUTTON_MIDDLE)) {
      input.pan_right += right;
      input.pan_down += down;
    }
  }

  GLFWmonitor* chosen_monitor() const {
    int count = 0;
    GLFWmonitor** const all = glfwGetMonitors(&count);
    if (count == 0) return nullptr;
    const auto monitors = std::span(all, static_cast<std::size_t>(count));
    return monitors[static_cast<std::size_t>(std::clamp(monitor.value_or(0), 0, count - 1))];
  }

  void toggle_fullscreen() {
    if (is_placed_by_wall) return;
    if (glfwGetWindowMonitor(window) != nullptr) {
      glfwSetWindowMonitor(window, nullptr, windowed_x, windowed_y, windowed_width, windowed_height, GLFW_DONT_CARE);
      return;
    }
    GLFWmonitor* const on = chosen_monitor();
    const GLFWvidmode* const mode = on != nullptr ? glfwGetVideoMode(on) : nullptr;
    if (mode == nullptr) return;
    glfwGetWindowPos(window, &windowed_x, &windowed_y);
    glfwGetWindowSize(window, &windowed_width, &windowed_height);
    glfwSetWindowMonitor(window, on, 0, 0, mode->width, mode->height, mode->refreshRate);
  }

  GLFWwindow* window = nullptr;
  std::optional<int> monitor;
  bool is_placed_by_wall = false;
  WindowInput input;
  bool is_mouse_taken = false;
  bool are_keys_taken = false;
  double cursor_x = 0.0;
  double cursor_y = 0.0;
  int windowed_x = 0;
  int windowed_y = 0;
  int windowed_width = 1280;
  int windowed_height = 720;
};

Window::Window(const WindowOptions& options) : state_(std::make_unique<State>(options)) {}
Window::~Window() = default;

GLFWwindow* Window::handle() const {
  return state_->window;
}
bool Window::is_closing() const {
  return glfwWindowShouldClose(state_->window) == GLFW_TRUE;
}

void Window::close() {
  glfwSetWindowShouldClose(state_->window, GLFW_TRUE);
}
void Window::toggle_fullscreen() {
  state_->toggle_fullscreen();
}

PixelSize Window::framebuffer_size() const {
  PixelSize size;
  glfwGetFramebufferSize(state_->window, &size.width_px, &size.height_px);
  return glfwGetWindowAttrib(state_->window, GLFW_ICONIFIED) == GLFW_TRUE ? PixelSize{} : size;
}

double Window::content_scale() const {
  float scale_x = 1.0F;
  float scale_y = 1.0F;
  glfwGetWindowContentScale(state_->window, &scale_x, &scale_y);
  return static_cast<double>(std::max(scale_x, scale_y));
}

double Window::refresh_rate_hz() const {
  GLFWmonitor* const on = state_->chosen_monitor();
  const GLFWvidmode* const mode = on != nullptr ? glfwGetVideoMode(on) : nullptr;
  return mode != nullptr && mode->refreshRate > 0 ? mode->refreshRate : 60.0;
}

void Window::poll() {
  glfwPollEvents();
}
void Window::wait(double limit_s) {
  glfwWaitEventsTimeout(limit_s);
}
WindowInput Window::take_input() {
  return std::exchange(state_->input, {});
}
void Window::set_taken(bool is_mouse_taken, bool are_keys_taken) {
  state_->is_mouse_taken = is_mouse_taken;
  state_->are_keys_taken = are_keys_taken;
}
void Window::swap() {
  glfwSwapBuffers(state_->window);
}

std::string list_monitors() {
  begin_glfw();
  std::string text = wall::monitors_text();
  glfwTerminate();
  return text;
}

}  // namespace yuragi::viewer::app
