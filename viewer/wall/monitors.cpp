#include "viewer/wall/monitors.hpp"

#include <algorithm>
#include <charconv>
#include <span>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace yuragi::viewer::wall {

std::vector<Monitor> monitors() {
  int count = 0;
  GLFWmonitor** const handles = glfwGetMonitors(&count);
  std::vector<Monitor> all;
  for (GLFWmonitor* handle : std::span(handles, static_cast<std::size_t>(count))) {
    const GLFWvidmode* const mode = glfwGetVideoMode(handle);
    const char* const name = glfwGetMonitorName(handle);
    if (mode == nullptr || name == nullptr) continue;
    Monitor monitor{.handle = handle,
                    .name = name,
                    .size = {.width_px = mode->width, .height_px = mode->height},
                    .refresh_rate_hz = mode->refreshRate};
    glfwGetMonitorPos(handle, &monitor.x_px, &monitor.y_px);
    all.push_back(std::move(monitor));
  }
  return all;
}

std::optional<Monitor> monitor_named(std::string_view wanted) {
  const std::vector<Monitor> all = monitors();
  const auto named = std::ranges::find(all, wanted, &Monitor::name);
  if (named != all.end()) return *named;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
  const bool is_number = wanted.empty() || (error == std::errc{} && end == wanted.data() + wanted.size());
  return is_number && number < all.size() ? std::optional(all[number]) : std::nullopt;
}

std::string monitors_text() {
  std::string text;
  const std::vector<Monitor> all = monitors();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Monitor& monitor = all[i];
    text += fmt::format("{}  {}  {} x {} at {} Hz, from {}, {}\n", i, monitor.name, monitor.size.width_px,
                        monitor.size.height_px, monitor.refresh_rate_hz, monitor.x_px, monitor.y_px);
  }
  return text.empty() ? "none\n" : text;
}

}  // namespace yuragi::viewer::wall
