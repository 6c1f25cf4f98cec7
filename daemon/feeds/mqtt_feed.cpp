#include "daemon/feeds/mqtt_feed.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "daemon/feeds/interval.hpp"
#include "daemon/feeds/mqtt_texts.hpp"
#include "daemon/feeds/wind_window.hpp"
#include "engine/base/address.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::feeds {
namespace {

using drivers::bus::MqttMessage;
using settings::feeds::Mqtt;
using values::Quantity;

/// The states of sensors and scenes are looked at so often: something that flaps sends no more.
constexpr double kChangesEvery_s = 1.0;
/// Home Assistant is sent all states at most so often.
constexpr double kStatesEvery_s = 5.0;
/// Scenes are shown and hidden at most so often in a second.
constexpr std::size_t kMaxCommands = 10;
constexpr double kRefusalsEvery_s = 60.0;
constexpr double kNamesKnownAfter_s = 10.0;
constexpr std::size_t kMaxReceived_bytes = 64;

class MqttFeed final : public Feed {
 public:
  MqttFeed(const Mqtt& config, const Surroundings& around, const MqttLink::Times& times)
      : config_(config),
        around_(around),
        device_{.id = home_assistant_id(config.topic), .url = around.page_url},
        link_(config, mqtt_subscriptions(config, device_.id), times),
        wind_(config.every_s),
        sensors_(config.every_s) {
    if (config.fast_hz > 0.0) fast_.emplace(1.0 / config.fast_hz);
    wind_.is_due(0.0);
  }

  void send(const values::Moment& moment) override {
    posts_.clear();
    rename(moment);
    take_received(moment);
    remove_old_entities(moment.time_s);
    const values::Readout& wind = moment.wind(config_.wind);
    window_.add(wind, moment.time_s);
    if (begun_s_ && wind_.is_due(moment.time_s - *begun_s_))
      post("wind", mqtt_wind_json(window_.take(), wind[Quantity::kLive], moment));
    if (!begun_s_) begun_s_ = moment.time_s;
    if (fast_ && fast_->is_due(moment.time_s)) post("fast", mqtt_fast_json(wind, moment));
    if (changes_.is_due(moment.time_s)) {
      add_sensors(moment);
      add_scenes(moment);
    }
    add_health(moment);
    link_.post(std::exchange(posts_, {}), moment.mono);
  }

  void finish() override { link_.finish(); }

  Status status() const override {
    const MqttLink::State state = link_.state();
    std::string sends = fmt::format("wind each {:g} s", config_.every_s);
    if (fast_) sends += fmt::format(", {:g} times a second", config_.fast_hz);
    if (!config_.home_assistant.empty()) sends += ", Home Assistant";
    if (config_.takes_commands) sends += ", takes commands";
    if (const std::uint64_t refused = refused_ + state.refused; refused > 0)
      sends += fmt::format(", refused {}", count_text(refused, "message"));
    return {.kind = "mqtt",
            .name = config_.topic,
            .target = to_string(Address{config_.host, config_.used_port()}),
            .sends = sends,
            .messages = state.messages,
            .bytes = state.bytes,
            .last_sent = state.last_sent,
            .trouble = state.trouble};
  }

 private:
  void post(const std::string& topic, std::string payload) {
    posts_.push_back({.topic = config_.topic + "/" + topic, .payload = std::move(payload)});
  }
  void post_state(const std::string& topic, std::string payload, bool is_retained) {
    posts_.push_back({.topic = config_.topic + "/" + topic,
                      .payload = std::move(payload),
                      .is_retained = is_retained,
                      .is_state = true});
  }
  static std::string text_of(const MqttMessage& message) { return {message.payload.begin(), message.payload.end()}; }
  static std::string on_or_off(bool is_on) { return is_on ? "ON" : "OFF"; }

  /// Other sensors, scenes or alerts.
  void rename(const values::Moment& moment) {
    const auto has_alerts_of = [this](const values::Health& health) {
      return std::ranges::equal(health.alerts, names_.alerts, {}, &values::AlertState::name);
    };
    if (moment.names == shared_names_ && has_alerts_of(*moment.health)) return;
    shared_names_ = moment.names;
    const MqttNames before = std::exchange(names_, mqtt_names_of(*moment.names, *moment.health));
    // The broker forgets what is gone.
    for (const std::string& part : before.alert_parts) {
      if (std::ranges::count(names_.alert_parts, part) == 0) post_state("alert/" + part, "", true);
    }
    for (const std::string& part : before.scene_parts) {
      if (std::ranges::count(names_.scene_parts, part) == 0) post_state("scene/" + part, "", false);
    }
    alerts_sent_.clear();
    states_sent_.assign(names_.sensors.size(), std::nullopt);
    opacities_sent_.assign(names_.scenes.size(), std::nullopt);
    if (!config_.home_assistant.empty()) post_discovery(home_assistant_entities(discovery_));
  }

  /// `before`: the entities that Home Assistant may know.
  void post_discovery(const HomeAssistantEntities& before) {
    discovery_ = home_assistant_config(config_, device_, names_, before);
    posts_.push_back({.topic = home_assistant_topic(config_, device_.id),
                      .payload = discovery_,
                      .is_retained = true,
                      .is_state = true});
  }

  /// Removes the entities that this installation had before it was started, and has no more. Not at once: names of
  /// scenes and alerts come with the first moments, and Home Assistant forgets what a person chose for what is removed.
  void remove_old_entities(double time_s) {
    if (entities_before_.empty() || !begun_s_ || time_s - *begun_s_ < kNamesKnownAfter_s) return;
    const HomeAssistantEntities now = home_assistant_entities(discovery_);
    const HomeAssistantEntities before = std::exchange(entities_before_, {});
    const auto is_known = [&now](const auto& entity) { return now.contains(entity.first); };
    if (!std::ranges::all_of(before, is_known)) post_discovery(before);
  }

  void add_sensors(const values::Moment& moment) {
    const bool is_due = sensors_.is_due(moment.time_s);
    for (std::size_t i = 0; i < std::min(moment.sensors.size(), names_.sensors.size()); ++i) {
      const values::SensorValue& sensor = moment.sensors[i];
      if (!is_due && states_sent_[i] == sensor.state) continue;
      states_sent_[i] = sensor.state;
      post("sensor/" + names_.sensor_parts[i], mqtt_sensor_json(sensor));
    }
  }

  void add_scenes(const values::Moment& moment) {
    for (std::size_t i = 0; i < std::min(moment.opacities.size(), names_.scenes.size()); ++i) {
      const bool is_shown = moment.opacities[i] > 0.0;
      if (opacities_sent_[i] == is_shown) continue;
      opacities_sent_[i] = is_shown;
      post_state("scene/" + names_.scene_parts[i], on_or_off(is_shown), false);
    }
  }

  void add_health(const values::Moment& moment) {
    const values::Health& health = *moment.health;
    if (needed_attention_ != health.needs_attention) {
      needed_attention_ = health.needs_attention;
      post_state("problem", on_or_off(health.needs_attention), true);
    }
    if (alerts_sent_ == health.alerts) return;
    for (std::size_t i = 0; i < health.alerts.size(); ++i) {
      if (i < alerts_sent_.size() && alerts_sent_[i] == health.alerts[i]) continue;
      post_state("alert/" + names_.alert_parts[i], on_or_off(health.alerts[i].is_on), true);
    }
    alerts_sent_ = health.alerts;
  }

  void take_received(const values::Moment& moment) {
    if (commands_.is_due(moment.time_s)) commands_taken_ = 0;
    for (const MqttMessage& message : link_.received()) take(message);
    if (wants_states_ && (!states_sent_s_ || moment.time_s - *states_sent_s_ >= kStatesEvery_s)) {
      wants_states_ = false;
      states_sent_s_ = moment.time_s;
      link_.post_states_again();
    }
    const std::uint64_t refused = refused_ + link_.state().refused;
    if (refused == refused_logged_ || !refusals_.is_due(moment.time_s)) return;
    spdlog::warn("feed mqtt: refused {}: allowed are show, hide, ON and OFF on {}/scene/NAME/set, {} in a second",
                 count_text(refused - refused_logged_, "message"), config_.topic, kMaxCommands);
    refused_logged_ = refused;
  }

  void take(const MqttMessage& message) {
    if (!config_.home_assistant.empty() && message.topic == home_assistant_topic(config_, device_.id)) {
      // One that is not retained is our own.
      if (message.is_retained) entities_before_ = home_assistant_entities(text_of(message));
      return;
    }
    // A message that was kept for later is no command of now. All states have been sent since the connection.
    const bool is_short = !message.is_too_long && message.payload.size() <= kMaxReceived_bytes;
    const std::string payload = is_short ? text_of(message) : std::string();
    const auto command =
        is_short ? mqtt_command_of(config_, names_, message.topic, payload) : std::optional<MqttCommand>();
    if (command && command->scene.empty()) {
      wants_states_ = wants_states_ || !message.is_retained;
    } else if (command && !message.is_retained && around_.show_scene && commands_taken_ < kMaxCommands) {
      ++commands_taken_;
      around_.show_scene(command->scene, command->shown);
    } else if (payload != "offline") {  // of Home Assistant
      ++refused_;
    }
  }

  Mqtt config_;
  Surroundings around_;
  HomeAssistantDevice device_;
  MqttLink link_;
  WindWindow window_;
  std::optional<double> begun_s_;
  Interval wind_, sensors_, changes_{kChangesEvery_s}, commands_{1.0}, refusals_{kRefusalsEvery_s};
  std::optional<Interval> fast_;
  std::shared_ptr<const values::Names> shared_names_;
  MqttNames names_;
  std::string discovery_;                  ///< the last one
  HomeAssistantEntities entities_before_;  ///< of an earlier run
  std::vector<values::AlertState> alerts_sent_;
  std::optional<bool> needed_attention_;
  std::vector<std::optional<wind::judging::SensorState>> states_sent_;
  std::vector<std::optional<bool>> opacities_sent_;
  std::vector<MqttPost> posts_;
  bool wants_states_ = false;
  std::optional<double> states_sent_s_;
  std::size_t commands_taken_ = 0;
  std::uint64_t refused_ = 0, refused_logged_ = 0;
};

}  // namespace

std::unique_ptr<Feed> make_mqtt_feed(const Mqtt& config, const Surroundings& around, const MqttLink::Times& times) {
  return std::make_unique<MqttFeed>(config, around, times);
}

}  // namespace yuragi::daemon::feeds
