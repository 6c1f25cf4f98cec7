#include "daemon/state/sensor_json.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/state/animation_load.hpp"
#include "daemon/state/json_value.hpp"

namespace yuragi::daemon::state {
namespace {

using nlohmann::ordered_json;

/// Zero stands for "not known" in these fields of the stream.
ordered_json positive_or_null(double number) {
  return number > 0.0 ? ordered_json(number) : ordered_json(nullptr);
}

/// Null for a value of a newer daemon that this program does not know.
template <class Enum>
ordered_json name_or_null(Enum value, const std::array<std::string_view, 3>& names) {
  const auto index = static_cast<std::size_t>(value);
  return index < names.size() ? ordered_json(names.at(index)) : ordered_json(nullptr);
}

constexpr std::array<std::string_view, 3> kWindSourceNames = {"default", "handover", "live"};
constexpr std::array<std::string_view, 3> kRecorderStateNames = {"writing", "retrying", "hanging"};

ordered_json json_of_wind(const wind::State& wind) {
  const bool blows = speed_of(wind.wind) > 0.0;
  return {{"speed_m_s", speed_of(wind.wind)},
          {"direction_deg", blows ? ordered_json(wind::direction_from_deg(wind.wind)) : ordered_json(nullptr)},
          {"source", name_or_null(wind.source, kWindSourceNames)},
          {"live_weight", wind.live_weight},
          {"upwind_m", wind.upwind_m},
          {"to_middle_s", wind.to_middle_s},
          {"is_place_configured", wind.is_place_configured}};
}

ordered_json json_of_quantities(const wire::SensorStatus& sensor) {
  ordered_json all = ordered_json::array();
  for (const wire::QuantityStatus& quantity : sensor.quantities) {
    all.push_back({{"name", name_of(quantity.quantity)},
                   {"age_s", json_or_null(quantity.age_s)},
                   {"is_missing", quantity.is_missing},
                   {"reason", quantity.reason}});
  }
  return all;
}

ordered_json json_of_sensor(const wire::SensorStatus& sensor) {
  ordered_json refused = ordered_json::object();
  for (const auto& [reason, count] : sensor.refused) refused[reason] = count;
  return {{"name", sensor.name},
          {"driver", sensor.driver},
          {"state", name_of(sensor.state)},
          {"state_reason", sensor.state_reason},
          {"value", sensor.value},
          {"reads_times_group", sensor.reads_times_group},
          {"link", name_of(sensor.link)},
          {"link_detail", sensor.detail},
          {"speed_m_s", json_or_null(sensor.speed_m_s)},
          {"direction_deg", json_or_null(sensor.direction_deg)},
          {"gust_m_s", json_or_null(sensor.gust_m_s)},
          {"quantities", json_of_quantities(sensor)},
          {"raw_speed_m_s", json_or_null(sensor.raw_speed_m_s)},
          {"raw_direction_deg", json_or_null(sensor.raw_direction_deg)},
          {"age_s", sensor.readings > 0 ? ordered_json(sensor.age_s) : ordered_json(nullptr)},
          {"interval_s", positive_or_null(sensor.interval_s)},
          {"frames", sensor.frames},
          {"readings", sensor.readings},
          {"reconnects", sensor.reconnects},
          {"refused", refused},
          {"is_simulated", sensor.simulated},
          {"is_replayed", sensor.replayed}};
}

ordered_json json_of_shaping(const wire::Shaping& shaping) {
  return {{"site_gain", shaping.site_gain},
          {"floor_gain", shaping.floor_gain},
          {"breeze_m_s", shaping.breeze_m_s},
          {"opening", shaping.opening},
          {"ceiling_gain", shaping.ceiling_gain},
          {"gusts", shaping.gusts},
          {"mean_m_s", shaping.mean_m_s},
          {"shaped_mean_m_s", shaping.shaped_mean_m_s},
          {"site_median_m_s", positive_or_null(shaping.site_median_m_s)},
          {"site_strong_m_s", positive_or_null(shaping.site_strong_m_s)},
          {"site_known_s", shaping.site_known_s},
          {"text", shaping.text}};
}

ordered_json json_of_hold(const std::optional<wire::Hold>& hold) {
  if (!hold) return nullptr;
  return {{"left_s", json_or_null(hold->left_s)}};
}

ordered_json json_of_cameras(const wire::Sensors& sensors) {
  ordered_json names = ordered_json::array();
  for (const look::Camera& camera : sensors.cameras) names.push_back(camera.name);
  return names;
}

ordered_json json_of_lateness(const std::optional<wire::Lateness>& lateness) {
  if (!lateness) return nullptr;
  return {{"p50_s", std::min(lateness->p50_s, lateness->max_s)},
          {"p99_s", std::min(lateness->p99_s, lateness->max_s)},
          {"max_s", lateness->max_s}};
}

ordered_json json_of_recorder(const std::optional<wire::RecorderStatus>& recorder) {
  if (!recorder) return nullptr;
  return {{"state", name_or_null(recorder->state, kRecorderStateNames)},
          {"written", recorder->written},
          {"waiting", recorder->waiting},
          {"lost", recorder->lost},
          {"recorded_elsewhere", recorder->recorded_elsewhere},
          {"free_bytes", json_or_null(recorder->free_bytes)},
          {"error", recorder->error},
          {"clock_doubt", recorder->clock_doubt}};
}

ordered_json json_of_animation(const std::optional<wire::AnimationStatus>& animation) {
  if (!animation) return nullptr;
  ordered_json scenes = ordered_json::array();
  for (const wire::SceneCost& scene : animation->scenes)
    scenes.push_back({{"name", scene.scene}, {"tick_s", scene.tick_s}, {"share", share_of(scene, *animation)}});
  return {{"running_s", animation->running_s},
          {"period_s", animation->period_s},
          {"tick_s", animation->tick_s},
          {"carried_times", json_or_null(carried_times(*animation))},
          {"scenes", scenes}};
}

ordered_json json_of_feeds(const std::vector<wire::FeedStatus>& feeds) {
  ordered_json all = ordered_json::array();
  for (const wire::FeedStatus& feed : feeds) {
    all.push_back({{"kind", feed.kind},
                   {"name", feed.name},
                   {"target", feed.target},
                   {"sends", feed.sends},
                   {"messages", feed.messages},
                   {"bytes", feed.bytes},
                   {"last_sent_age_s", json_or_null(feed.last_sent_age_s)},
                   {"trouble", feed.trouble}});
  }
  return all;
}

}  // namespace

ordered_json sensors_json(const wire::Sensors& sensors) {
  ordered_json all = ordered_json::array();
  for (const wire::SensorStatus& sensor : sensors.sensors) all.push_back(json_of_sensor(sensor));
  return {{"wind", json_of_wind(sensors.wind)},
          {"sensors", all},
          {"shaping", json_of_shaping(sensors.shaping)},
          {"by_hand", by_hand_json(sensors.by_hand)},
          {"cameras", json_of_cameras(sensors)},
          {"camera", sensors.camera < sensors.cameras.size() ? ordered_json(sensors.cameras[sensors.camera].name)
                                                             : ordered_json(nullptr)},
          {"recorder", json_of_recorder(sensors.recorder)},
          {"clients",
           {{"connected", sensors.clients},
            {"refused", sensors.refused_clients},
            {"stuck", sensors.stuck_clients},
            {"idle", sensors.idle_clients}}},
          {"gust_reach",
           {{"across", json_or_null(sensors.gust_reach_across)}, {"along", json_or_null(sensors.gust_reach_along)}}},
          {"late_ticks", sensors.late_ticks},
          {"recent_ticks", sensors.recent_ticks},
          {"recent_skipped_ticks", sensors.recent_skipped_ticks},
          {"io_lateness", json_of_lateness(sensors.io_lateness)},
          {"tick_lateness", json_of_lateness(sensors.tick_lateness)},
          {"animation", json_of_animation(sensors.animation)},
          {"feeds", json_of_feeds(sensors.feeds)}};
}

ordered_json by_hand_json(const wire::ByHand& by_hand) {
  ordered_json wind = nullptr;
  if (by_hand.wind) {
    wind = {{"speed_m_s", by_hand.wind->speed_m_s},
            {"direction_deg", by_hand.wind->direction_deg},
            {"left_s", by_hand.wind->left_s}};
  }
  return {{"wind", std::move(wind)},
          {"blackout", json_of_hold(by_hand.blackout)},
          {"camera", json_of_hold(by_hand.camera)}};
}

ordered_json raw_trace_json(const wire::RawTrace& trace) {
  std::string digits;
  for (const std::uint8_t byte : trace.bytes) digits += fmt::format("{:02x}", byte);
  return {{"sensor", trace.sensor},
          {"utc_ns", trace.utc_ns},
          {"mono_ns", trace.mono_ns},
          {"is_received", trace.received},
          {"hex", digits},
          {"length_bytes", trace.length},
          {"lost", trace.lost}};
}

ordered_json scenes_json(const std::vector<wire::SceneState>& scenes) {
  ordered_json all = ordered_json::array();
  for (const wire::SceneState& scene : scenes)
    all.push_back({{"name", scene.name}, {"kind", scene.kind}, {"is_shown", scene.shown}});
  return all;
}

ordered_json players_json(const std::vector<wire::PlayerState>& players) {
  ordered_json all = ordered_json::array();
  for (const wire::PlayerState& player : players) {
    const auto if_open = [&](const ordered_json& value) { return player.is_open ? value : ordered_json(nullptr); };
    all.push_back({{"sensor", player.sensor},
                   {"file", player.file},
                   {"is_open", player.is_open},
                   {"position_s", if_open(player.position_s)},
                   {"length_s", if_open(player.length_s)},
                   {"recorded_utc_ns", if_open(player.recorded_utc_ns)},
                   {"rate", if_open(player.rate)},
                   {"is_paused", if_open(player.is_paused)},
                   {"is_finished", if_open(player.is_finished)},
                   {"loops", if_open(player.loops)},
                   {"rounds", if_open(player.rounds)},
                   {"refusal", player.refusal}});
  }
  return all;
}

}  // namespace yuragi::daemon::state
