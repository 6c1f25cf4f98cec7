#include "daemon/settings/scene_config.hpp"

#include <utility>

namespace yuragi::daemon::settings {

SceneConfig scene_config_of(std::string name, const scenes::SceneDescription& kind, ParameterValues values) {
  SceneConfig scene{.name = std::move(name), .kind = &kind, .values = std::move(values)};
  scene.placement = {.x_m = scene.values.number("x"),
                     .y_m = scene.values.number("y"),
                     .z_m = scene.values.number("z"),
                     .heading_deg = scene.values.number("heading")};
  scene.wind_gain = scene.values.number("gain");
  scene.is_shown = scene.values.flag("shown");
  return scene;
}

}  // namespace yuragi::daemon::settings
