#include "daemon/service/parameter_groups.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/service/reload_report.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/settings/scene_config.hpp"

namespace yuragi::daemon::service {
namespace {

std::optional<double> limit_of(double limit) {
  return std::isfinite(limit) ? std::optional<double>(limit) : std::nullopt;
}

/// A parameter as its table describes it, without a value.
wire::ParameterState described(const Parameter& parameter) {
  static constexpr wire::ParameterKind kKinds[] = {wire::ParameterKind::kYesNo, wire::ParameterKind::kWholeNumber,
                                                   wire::ParameterKind::kNumber, wire::ParameterKind::kText,
                                                   wire::ParameterKind::kText};
  static_assert(std::size(kKinds) == std::variant_size_v<ParameterValue>, "in the order of ParameterValue");
  wire::ParameterState state{.name = std::string(parameter.name),
                             .unit = std::string(parameter.unit),
                             .kind = kKinds[parameter.default_value.index()],
                             .min = limit_of(parameter.min),
                             .max = limit_of(parameter.max),
                             .choices = {parameter.choices.begin(), parameter.choices.end()},
                             .help = std::string(parameter.help),
                             .left_out = std::string(parameter.left_out)};
  if (parameter.left_out.empty()) state.default_value = value_text(parameter.default_value);
  return state;
}

std::optional<std::string> value_in(const ParameterValues& values, std::string_view key) {
  const auto found = values.all().find(key);
  return found == values.all().end() ? std::nullopt : std::optional(value_text(found->second));
}

wire::ParameterGroup look_group(const settings::Config& running, const settings::Config& configured) {
  const settings::ConfigTable& table = settings::config_table("look");
  wire::ParameterGroup group;
  for (const Parameter& parameter : table.parameters) {
    wire::ParameterState& state = group.parameters.emplace_back(described(parameter));
    state.value = value_in(running.by_name.at(table.name), parameter.name);
    state.configured = value_in(configured.by_name.at(table.name), parameter.name);
    state.change = parameter.change.value_or(table.change);
  }
  return group;
}

wire::ParameterGroup scene_group(const settings::SceneConfig& scene, const settings::SceneConfig* configured,
                                 bool is_shown) {
  wire::ParameterGroup group{.scene = scene.name, .kind = std::string(scene.kind->name), .parameters = {}};
  for (const Parameter& parameter : settings::scene_parameters(*scene.kind)) {
    wire::ParameterState& state = group.parameters.emplace_back(described(parameter));
    state.value = parameter.name == "shown" ? value_text(is_shown) : value_in(scene.values, parameter.name);
    state.configured = configured == nullptr ? state.default_value : value_in(configured->values, parameter.name);
    state.change = parameter.change.value_or(settings::kSceneKeyChange);
  }
  return group;
}

}  // namespace

std::vector<wire::ParameterGroup> parameter_groups(const settings::Config& running, const settings::Config& configured,
                                                   std::span<const wire::SceneState> scenes) {
  std::vector<wire::ParameterGroup> groups{look_group(running, configured)};
  for (const settings::SceneConfig& scene : running.scenes) {
    const auto state = std::ranges::find(scenes, scene.name, &wire::SceneState::name);
    if (state == scenes.end()) continue;
    const auto before = std::ranges::find(configured.scenes, scene.name, &settings::SceneConfig::name);
    groups.push_back(scene_group(scene, before == configured.scenes.end() ? nullptr : &*before, state->shown));
  }
  return groups;
}

std::vector<wire::ParameterGroup> without_folders(std::vector<wire::ParameterGroup> groups) {
  for (wire::ParameterGroup& group : groups) {
    for (wire::ParameterState& parameter : group.parameters) {
      if (parameter.kind != wire::ParameterKind::kText) continue;
      for (auto* const value : {&parameter.value, &parameter.configured}) {
        if (*value) **value = without_path_folders(**value);
      }
    }
  }
  return groups;
}

}  // namespace yuragi::daemon::service
