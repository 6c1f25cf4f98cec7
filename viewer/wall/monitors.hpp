#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/output/output.hpp"

struct GLFWmonitor;

namespace yuragi::viewer::wall {

/// A connected monitor.
struct Monitor {
  GLFWmonitor* handle = nullptr;
  std::string name = {};  ///< of its connector: "HDMI-1"
  int x_px = 0;           ///< on the desktop
  int y_px = 0;
  output::Size size = {};
  int refresh_rate_hz = 0;
  friend bool operator==(const Monitor&, const Monitor&) = default;
};

/// All of them, the primary one first. After glfwInit(), on the main thread.
std::vector<Monitor> monitors();

/// Returns the monitor of a configuration: by its name, by its number from 0, or the primary one if that is empty.
/// Nullopt if it is not connected.
std::optional<Monitor> monitor_named(std::string_view wanted);

/// A line for each: "0  HDMI-1  1920 x 1080 at 60 Hz, from 0, 0". For people.
std::string monitors_text();

}  // namespace yuragi::viewer::wall
