#include "viewer/wall/window_map.hpp"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

namespace yuragi::viewer::wall {
namespace {

/// Converts from the monitor to the picture, which hangs rotated on it.
glm::dmat3 unrotated(int rotation_deg) {
  // Columns: the images of (1, 0), (0, 1) and the origin.
  switch (rotation_deg) {
    case 90:
      return {{0, -1, 0}, {1, 0, 0}, {0, 1, 1}};
    case 180:
      return {{-1, 0, 0}, {0, -1, 0}, {1, 1, 1}};
    case 270:
      return {{0, 1, 0}, {-1, 0, 0}, {1, 0, 1}};
    default:
      return glm::dmat3(1.0);
  }
}

}  // namespace

glm::dmat3 square_to(const output::Corners& corners) {
  const auto& [a, b, c, d] = corners;
  const double sum_x = a.x - b.x + c.x - d.x;
  const double sum_y = a.y - b.y + c.y - d.y;
  const double across_x = b.x - c.x;
  const double across_y = b.y - c.y;
  const double down_x = d.x - c.x;
  const double down_y = d.y - c.y;
  const double area = across_x * down_y - across_y * down_x;
  const double g = (sum_x * down_y - sum_y * down_x) / area;
  const double h = (across_x * sum_y - across_y * sum_x) / area;
  return {
      {b.x - a.x + g * b.x, b.y - a.y + g * b.y, g}, {d.x - a.x + h * d.x, d.y - a.y + h * d.y, h}, {a.x, a.y, 1.0}};
}

glm::dmat3 monitor_to_crop(const output::Window& window) {
  return glm::inverse(square_to(window.corners)) * unrotated(window.rotation_deg);
}

glm::dvec2 mapped(const glm::dmat3& map, const glm::dvec2& place) {
  const glm::dvec3 at = map * glm::dvec3(place, 1.0);
  return glm::dvec2(at) / at.z;
}

output::Sides blend_of_crop(const output::Window& window) {
  return {.left = window.blend.left / window.crop.width,
          .right = window.blend.right / window.crop.width,
          .top = window.blend.top / window.crop.height,
          .bottom = window.blend.bottom / window.crop.height};
}

output::Size picture_size(const output::Output& output, std::span<const output::Size> monitors) {
  if (output.size) return *output.size;
  output::Size size;
  const auto whole = [](int shown_px, double part) {
    return std::clamp(static_cast<int>(std::lround(shown_px / part)), 1, output::kMaxSide_px);
  };
  for (std::size_t i = 0; i < std::min(monitors.size(), output.windows.size()); ++i) {
    const output::Window& window = output.windows[i];
    output::Size shown = monitors[i];
    if (shown.width_px <= 0 || shown.height_px <= 0) continue;
    if (window.rotation_deg % 180 != 0) std::swap(shown.width_px, shown.height_px);
    size.width_px = std::max(size.width_px, whole(shown.width_px, window.crop.width));
    size.height_px = std::max(size.height_px, whole(shown.height_px, window.crop.height));
  }
  return size;
}

}  // namespace yuragi::viewer::wall
