#include "daemon/tools/sensors/daemon_status.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/settings/duration_text.hpp"
#include "daemon/state/animation_load.hpp"
#include "daemon/state/attention.hpp"
#include "daemon/state/sensor_json.hpp"
#include "daemon/tools/sensors/player_text.hpp"
#include "daemon/tools/sensors/sensor_table.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::tools::sensors {
namespace {

/// ", 1.52 ms a tick, 82 % of the animation's work"; empty if it is not known.
std::string cost_text(const wire::SceneState& scene, const std::optional<wire::AnimationStatus>& animation) {
  if (!animation || !scene.shown) return {};
  const auto cost = std::ranges::find(animation->scenes, scene.name, &wire::SceneCost::scene);
  if (cost == animation->scenes.end()) return {};
  return fmt::format(", {:.2f} ms a tick, {:.0f} % of the animation's work", 1e3 * cost->tick_s,
                     1e2 * state::share_of(*cost, *animation));
}

/// "feed wall (osc) to 192.168.1.40:9000: wind, sensors; 360 messages, the last 0.0 s ago".
std::string feed_text(const wire::FeedStatus& feed) {
  std::string text = fmt::format("feed {} ({}) to {}: {}; {}", feed.name, feed.kind, feed.target, feed.sends,
                                 count_text(feed.messages, "message"));
  if (feed.last_sent_age_s) text += fmt::format(", the last {:.1f} s ago", *feed.last_sent_age_s);
  if (!feed.trouble.empty()) text += "; CANNOT SEND: " + feed.trouble;
  return text + '\n';
}

}  // namespace

std::string status_text(const DaemonStatus& status) {
  const std::vector<std::string> attention = state::needs_attention(status.sensors);
  std::string text = fmt::format("{} at {}", status.software, status.address);
  const std::optional<wire::AnimationStatus>& animation = status.sensors.animation;
  if (animation) text += fmt::format(", running for {}", settings::duration_text(animation->running_s));
  text += attention.empty() ? ": all is well\n" : ": needs attention\n";
  for (const std::string& sentence : attention) text += fmt::format("  - {}\n", sentence);
  text += "\n" + sensor_table(status.sensors);
  if (!status.scenes.empty()) text += '\n';
  if (animation) text += fmt::format("animation: {}\n", state::animation_text(*animation));
  for (const wire::SceneState& scene : status.scenes)
    text += fmt::format("scene {} ({}): {}{}\n", scene.name, scene.kind, scene.shown ? "shown" : "hidden",
                        cost_text(scene, animation));
  if (!status.sensors.feeds.empty()) text += '\n';
  for (const wire::FeedStatus& feed : status.sensors.feeds) text += feed_text(feed);
  if (!status.players.empty()) text += '\n';
  for (const wire::PlayerState& player : status.players) text += "recording " + player_text(player);
  return text;
}

nlohmann::ordered_json status_json(const DaemonStatus& status) {
  const std::vector<std::string> attention = state::needs_attention(status.sensors);
  nlohmann::ordered_json json = {{"verdict", attention.empty() ? "well" : "attention"},
                                 {"attention", attention},
                                 {"address", status.address},
                                 {"software", status.software},
                                 {"tick_rate_hz", status.tick_rate_hz},
                                 {"running_s", nullptr}};
  if (status.sensors.animation) json["running_s"] = status.sensors.animation->running_s;
  json.update(state::sensors_json(status.sensors));
  json["scenes"] = state::scenes_json(status.scenes);
  json["players"] = state::players_json(status.players);
  return json;
}

}  // namespace yuragi::daemon::tools::sensors
