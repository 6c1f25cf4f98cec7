#include "daemon/animation/scene_change.hpp"

#include <algorithm>
#include <optional>

#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/reach.hpp"

namespace yuragi::daemon::animation {
namespace {

bool is_same_place(const scenes::Placement& a, const scenes::Placement& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.z_m == b.z_m && a.heading_deg == b.heading_deg;
}

/// Returns true if all parameters of its kind, and its picture, are the same. Others, such as its gain, are not needed
/// to make a scene.
bool is_same_model(const settings::SceneConfig& a, const settings::SceneConfig& b) {
  if (a.kind != b.kind || a.cloth != b.cloth || !is_same_place(a.placement, b.placement)) return false;
  return std::ranges::all_of(a.kind->parameters, [&](const Parameter& parameter) {
    const auto one = a.values.all().find(parameter.name);
    const auto other = b.values.all().find(parameter.name);
    const bool has_one = one != a.values.all().end();
    const bool has_other = other != b.values.all().end();
    return has_one == has_other && (!has_one || one->second == other->second);
  });
}

/// Returns the scene of `present` that equals the one wanted by `next` at `index`. The seed, of which the index is a
/// part, decides which one.
std::optional<std::size_t> find_same(const SceneRoster& present, const settings::Config& next, std::size_t index) {
  const std::uint64_t from_first = next.seed + index - present.seed;  // wraps round, as seeds do
  if (from_first >= present.configs.size()) return std::nullopt;
  const auto candidate = static_cast<std::size_t>(from_first);
  if (!is_same_model(present.configs[candidate], next.scenes[index])) return std::nullopt;
  return candidate;
}

std::optional<std::size_t> find_name(const SceneRoster& present, const std::string& name) {
  const auto found = std::ranges::find(present.configs, name, &settings::SceneConfig::name);
  if (found == present.configs.end()) return std::nullopt;
  return static_cast<std::size_t>(found - present.configs.begin());
}

/// Returns true if clients would see no difference between the two lists.
bool is_same_list(const SceneRoster& a, const SceneRoster& b) {
  return std::ranges::equal(a.scenes, b.scenes) &&
         std::ranges::equal(a.configs, b.configs, {}, &settings::SceneConfig::name, &settings::SceneConfig::name);
}

}  // namespace

void SceneChange::begin_fades() noexcept {
  // First copies what is shown now, then begins the fades, which change it.
  for (Start& start : starts) {
    if (start.shown_like != nullptr) start.shown = start.shown_like->fade.is_shown();
  }
  for (const Start& start : starts) {
    start.scene->wind_gain = start.wind_gain;
    if (start.scene->fade.is_shown() != start.shown) start.scene->fade.begin(start.shown, fade_s);
  }
  for (const auto& scene : leaving) scene->fade.begin(false, fade_s);
}

bool SceneChange::has_faded_out() const noexcept {
  return std::ranges::all_of(leaving, [](const auto& scene) { return scene->fade.opacity() == 0.0F; });
}

std::unique_ptr<SceneChange> make_scene_change(const SceneRoster& present, const settings::Config& next,
                                               double fade_s) {
  auto change = std::make_unique<SceneChange>();
  change->fade_s = fade_s;
  auto roster = std::make_shared<SceneRoster>();
  roster->seed = next.seed;
  roster->settles = present.settles;
  roster->gusts = present.gusts;
  roster->configs = next.scenes;

  // The scenes that stay, and those that are made.
  std::vector<bool> stays(present.scenes.size());
  for (std::size_t i = 0; i < next.scenes.size(); ++i) {
    if (const auto same = find_same(present, next, i)) {
      stays[*same] = true;
      ++change->kept;
      roster->scenes.push_back(present.scenes[*same]);
    } else {
      ++change->made;
      roster->scenes.push_back(make_staged_scene(next, i, present.gusts));
    }
    const settings::SceneConfig& config = next.scenes[i];
    const auto before = find_name(present, config.name);
    const bool is_as_before = before && present.configs[*before].is_shown == config.is_shown;
    change->starts.push_back({.scene = roster->scenes.back().get(),
                              .wind_gain = config.wind_gain,
                              .shown_like = is_as_before ? present.scenes[*before].get() : nullptr,
                              .shown = config.is_shown});
  }

  // What leaves.
  std::vector<SceneList::Entry> leaving;
  for (std::size_t i = 0; i < present.scenes.size(); ++i) {
    if (stays[i]) continue;
    const settings::SceneConfig& config = present.configs[i];
    leaving.push_back({config.name, std::string(config.kind->name), present.scenes[i], config.cloth});
    change->leaving.push_back(present.scenes[i]);
  }
  change->leaving_count = leaving.size();

  // The lists, and the messages for clients.
  std::uint64_t generation = present.generation;
  const auto announce = [&](wire::Bytes message) {
    change->messages.push_back({generation, std::make_shared<const wire::Bytes>(std::move(message))});
  };
  if (!leaving.empty()) {
    auto both = std::make_unique<SceneList>(roster, leaving, generation + 1);
    if (auto message = scenes_message(both->describe())) {
      ++generation;
      announce(std::move(*message));
      change->both = std::move(both);
    }
  }
  const bool is_news = !is_same_list(present, *roster);
  if (is_news) ++generation;
  roster->generation = generation;
  change->last = std::make_unique<SceneList>(roster, std::span<const SceneList::Entry>(), generation);
  if (is_news) announce(checked_scenes_message(change->last->describe()));
  change->reach_m = pose::scenes_reach_m(change->last->skeletons());
  for (const pose::Skeleton* skeleton : change->last->skeletons()) change->node_count += pose::node_count(*skeleton);
  change->roster = std::move(roster);
  return change;
}

}  // namespace yuragi::daemon::animation
