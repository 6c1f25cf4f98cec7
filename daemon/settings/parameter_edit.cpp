#include "daemon/settings/parameter_edit.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::settings {
namespace {

/// The error with the table's name before the key.
ParameterError error_in(std::string_view table, const ParameterError& error) {
  return {fmt::format("{}.{}", table, error.name), error.message};
}

/// `values` of a table with one of them changed. `configured`: where it goes back to; null: to its default.
Result<ParameterValues, ParameterError> with_edit(std::span<const Parameter> table, const ParameterValues& values,
                                                  const ParameterValues* configured, const ParameterEdit& edit) {
  ParameterValues::Map given = values.all();
  const auto parameter = std::ranges::find(table, edit.key, &Parameter::name);
  if (edit.value || parameter == table.end()) {
    const std::string text = edit.value.value_or("");
    given.insert_or_assign(edit.key, parameter == table.end() ? ParameterValue(text) : typed_value(*parameter, text));
  } else if (configured != nullptr && configured->has(edit.key)) {
    given.insert_or_assign(edit.key, configured->all().at(edit.key));
  } else {
    given.erase(edit.key);
  }
  return ParameterValues::resolve(table, given);
}

/// Why a key is not changed while the daemon runs; nullopt: it is, or it is not known.
std::optional<ParameterError> refusal(std::string_view table, std::span<const Parameter> parameters,
                                      KeyChange otherwise, const ParameterEdit& edit) {
  const auto parameter = std::ranges::find(parameters, edit.key, &Parameter::name);
  if (parameter == parameters.end()) return std::nullopt;
  const KeyChange change = parameter->change.value_or(otherwise);
  if (change == KeyChange::kTakesRestart) {
    return error_in(table, {edit.key, "needs a restart: write it into the configuration and restart the daemon"});
  }
  if (change == KeyChange::kTakesReload) {
    return error_in(table, {edit.key, "is read only from the configuration: write it there, then run yuragi reload"});
  }
  return std::nullopt;
}

std::optional<ParameterError> edit_look(Config& config, const Config& configured, const ParameterEdit& edit) {
  const ConfigTable& table = config_table("look");
  if (auto refused = refusal("look", table.parameters, table.change, edit)) return refused;
  ParameterValues& running = config.by_name.at(table.name);
  auto values = with_edit(table.parameters, running, &configured.by_name.at(table.name), edit);
  if (!values) return error_in("look", values.error());
  running = std::move(*values);
  const std::vector<ParameterError> errors = table.fill(config, running);
  if (!errors.empty()) return error_in("look", errors.front());
  return std::nullopt;
}

std::optional<ParameterError> edit_scene(Config& config, const Config& configured, const ParameterEdit& edit) {
  const auto scene = std::ranges::find(config.scenes, edit.scene, &SceneConfig::name);
  if (scene == config.scenes.end()) {
    std::string known;
    for (const SceneConfig& one : config.scenes) known.append(known.empty() ? "" : ", ").append(one.name);
    return ParameterError{"scene", fmt::format("there is no scene \"{}\"; there are: {}", edit.scene, known)};
  }
  const auto gone = std::ranges::find(scene->kind->retired, edit.key, &scenes::RetiredParameter::name);
  if (gone != scene->kind->retired.end()) return ParameterError{"scene." + edit.key, std::string(gone->now)};
  const std::vector<Parameter> parameters = scene_parameters(*scene->kind);
  if (auto refused = refusal("scene", parameters, kSceneKeyChange, edit)) return refused;
  const auto before = std::ranges::find(configured.scenes, edit.scene, &SceneConfig::name);
  const bool is_configured = before != configured.scenes.end() && before->kind == scene->kind;
  auto values = with_edit(parameters, scene->values, is_configured ? &before->values : nullptr, edit);
  if (!values) return error_in("scene", values.error());
  auto cloth = cloth_look_of(*values, std::nullopt);
  if (!cloth) return error_in("scene", cloth.error().front());
  // The rest of the scene does not change.
  cloth->image = scene->cloth.image;
  scene->cloth = std::move(*cloth);
  SceneConfig next = scene_config_of(scene->name, *scene->kind, std::move(*values));
  scene->values = std::move(next.values);
  scene->placement = next.placement;
  scene->wind_gain = next.wind_gain;
  scene->is_shown = next.is_shown;
  return std::nullopt;
}

}  // namespace

Result<Config, ParameterError> edited(const Config& running, const Config& configured,
                                      std::span<const ParameterEdit> edits) {
  Config config = running;
  for (const ParameterEdit& edit : edits) {
    const auto error = edit.scene.empty() ? edit_look(config, configured, edit) : edit_scene(config, configured, edit);
    if (error) return *error;
  }
  return {boost::system::in_place_value, std::move(config)};
}

}  // namespace yuragi::daemon::settings
