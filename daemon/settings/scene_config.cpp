#include "daemon/settings/scene_config.hpp"

#include <span>
#include <utility>

#include "daemon/settings/config_tables.hpp"

namespace yuragi::daemon::settings {

std::vector<Parameter> scene_parameters(const scenes::SceneDescription& kind) {
  std::vector<Parameter> all(kind.parameters.begin(), kind.parameters.end());
  const std::span<const Parameter> common = common_scene_parameters();
  all.insert(all.end(), common.begin(), common.end());
  return all;
}

bool remakes_scene(std::string_view key) noexcept {
  return key != "gain" && key != "shown";
}

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
