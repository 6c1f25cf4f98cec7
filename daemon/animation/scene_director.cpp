#include "daemon/animation/scene_director.hpp"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "daemon/settings/control_permission.hpp"

namespace yuragi::daemon::animation {

SceneDirector::SceneDirector(const settings::Config& config, SendCue send_cue)
    : allowed_(config.stream.control), send_cue_(std::move(send_cue)) {
  for (const settings::SceneConfig& scene : config.scenes) {
    scenes_.push_back({scene.name, std::string(scene.kind->name), scene.is_shown});
    configured_shown_.push_back(scene.is_shown);
  }
}

void SceneDirector::follow(const SceneRoster& roster) {
  const std::vector<wire::SceneState> before = std::exchange(scenes_, {});
  const std::vector<bool> configured_before = std::exchange(configured_shown_, {});
  for (const settings::SceneConfig& scene : roster.configs) {
    bool is_shown = scene.is_shown;
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (before[i].name == scene.name && configured_before[i] == scene.is_shown) is_shown = before[i].shown;
    }
    scenes_.push_back({scene.name, std::string(scene.kind->name), is_shown});
    configured_shown_.push_back(scene.is_shown);
  }
}

void SceneDirector::resume(const SceneRoster& roster) {
  for (std::size_t i = 0; i < scenes_.size(); ++i) scenes_[i].shown = roster.scenes.at(i)->fade.is_shown();
}

void SceneDirector::note_shown(std::span<const std::uint8_t> shown) {
  for (std::size_t i = 0; i < std::min(scenes_.size(), shown.size()); ++i) scenes_[i].shown = shown[i] != 0;
}

void SceneDirector::note(const SceneCue& cue) {
  if (cue.scene >= scenes_.size()) return;
  if (cue.hide_others) {
    for (wire::SceneState& scene : scenes_) scene.shown = false;
  }
  scenes_[cue.scene].shown = cue.shown;
}

wire::ControlReply SceneDirector::handle(const wire::Control& control, bool is_local) {
  return carry_out(control, settings::control_refusal(allowed_, is_local, "scenes cannot be switched"));
}

wire::ControlReply SceneDirector::handle_permitted(const wire::Control& control) {
  return carry_out(control, std::nullopt);
}

wire::ControlReply SceneDirector::carry_out(const wire::Control& control, const std::optional<std::string>& refusal) {
  if (control.scene.empty()) return {.done = true, .message = "nothing was changed", .scenes = scenes_};
  const auto found =
      std::find_if(scenes_.begin(), scenes_.end(), [&](const auto& scene) { return scene.name == control.scene; });
  if (found == scenes_.end()) {
    std::string known;
    for (const wire::SceneState& scene : scenes_) known.append(known.empty() ? "" : ", ").append(scene.name);
    return refuse(fmt::format("there is no scene \"{}\"; there are: {}", control.scene, known));
  }
  if (refusal) return refuse(*refusal);

  const auto index = static_cast<std::size_t>(found - scenes_.begin());
  if (!send_cue_({index, control.shown, control.hide_others, control.over_s}))
    return refuse("too many changes at once; try again");
  if (control.hide_others) {
    for (wire::SceneState& scene : scenes_) scene.shown = false;
  }
  found->shown = control.shown;
  return {.done = true,
          .message = fmt::format("{} is {}{}, over {:g} s", control.scene, control.shown ? "shown" : "hidden",
                                 control.hide_others ? ", every other scene hidden" : "", control.over_s),
          .scenes = scenes_};
}

wire::ControlReply SceneDirector::refuse(std::string why) const {
  return {.done = false, .message = std::move(why), .scenes = scenes_};
}

}  // namespace yuragi::daemon::animation
