// Any text as a configuration with an [[output]]: it is refused with a place and a reason, or what it says of the wall
// can be shown.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "engine/output/output_tables.hpp"

namespace {

using namespace yuragi;

void demand(bool holds) {
  if (!holds) std::abort();
}

/// Is it a part of the whole?
bool is_part(double value) {
  return value >= 0.0 && value <= 1.0;
}

void demand_that_it_can_be_shown(const output::Output& wall) {
  demand(!wall.windows.empty() && wall.windows.size() <= output::kMaxWindows);
  demand(wall.refreshes >= 1);
  if (wall.delay_s) demand(*wall.delay_s >= output::kMinDelay_s && *wall.delay_s <= output::kMaxDelay_s);
  if (wall.size) {
    demand(wall.size->width_px > 0 && wall.size->width_px <= output::kMaxSide_px);
    demand(wall.size->height_px > 0 && wall.size->height_px <= output::kMaxSide_px);
  }
  if (wall.screen) {
    for (const output::RoomPlace& place :
         {wall.screen->lower_left_m, wall.screen->lower_right_m, wall.screen->upper_left_m, wall.screen->eye_m}) {
      for (const double axis_m : place) demand(std::isfinite(axis_m));
    }
  }
  for (const output::Window& window : wall.windows) {
    const output::Crop& crop = window.crop;
    demand(is_part(crop.x) && is_part(crop.y) && crop.width > 0.0 && is_part(crop.width) && crop.height > 0.0 &&
           is_part(crop.height));
    demand(window.rotation_deg % 90 == 0 && window.rotation_deg >= 0 && window.rotation_deg < 360);
    for (const output::Place& corner : window.corners) demand(std::isfinite(corner.x) && std::isfinite(corner.y));
    const output::Sides& blend = window.blend;
    demand(is_part(blend.left) && is_part(blend.right) && is_part(blend.top) && is_part(blend.bottom));
    demand(std::isfinite(window.gamma) && window.gamma > 0.0);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  // Most inputs begin with the tables, so that their keys are reached.
  std::string text = (data[0] & 1) != 0 ? "[[output]]\n" : "";
  if ((data[0] & 2) != 0) text += "screen_lower_left = \"-1 0.5 0\"\nscreen_lower_right = \"1 0.5 0\"\n";
  if ((data[0] & 4) != 0) text += "[[output.window]]\n";
  if ((data[0] & 8) != 0) text += "corners = \"";
  if ((data[0] & 16) != 0) text += "crop = \"0 0 ";
  for (std::size_t i = 1; i < size; ++i) text += static_cast<char>(data[i]);

  const auto outputs = output::parse_outputs(text, "wall.toml");
  if (!outputs) {
    demand(std::string_view(outputs.error().message).starts_with("wall.toml"));
    return 0;
  }
  demand(outputs->size() <= output::kMaxOutputs);
  for (const output::Output& wall : *outputs) demand_that_it_can_be_shown(wall);
  return 0;
}
