// Wind that somebody publishes on an MQTT broker (OASIS, "MQTT Version 3.1.1", 2014): a home's weather station, a
// gateway, a microcontroller. Speed, direction and gust may come in one JSON message or each on a topic of its own.
// Common publishers have a preset, which single settings override:
//
//   preset     topic               speed                 direction           gust              unit
//   number     (yours, one each)   the payload is the number                                   m/s
//   tasmota    tele/+/SENSOR       /TX23/Speed/Act       /TX23/Dir/Deg       /TX23/Speed/Max   km/h
//   rtl_433    rtl_433/+/events    /wind_avg_m_s         /wind_dir_deg       /wind_max_m_s     m/s
//   windnerd   (yours)             /wind_instant_speed   /wind_instant_dir                     m/s
//
// Sources: Home Assistant's mqtt_statestream publishes numbers on homeassistant/sensor/NAME/state; arendst/Tasmota
// tasmota/xsns_35_tx20.ino, Tx2xShow (TX20 in place of TX23 for the older sensor; its SpeedUnit is km/h unless it was
// changed); merbanan/rtl_433 src/devices/fineoffset_ws80.c, as for most wind sensors; windnerd.net/docs, MQTT.
//
// A retained message was kept by the broker for later subscribers: its age is unknown, and it is never taken for the
// live wind.
#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "drivers/bus/mqtt_client.hpp"
#include "drivers/decode/decoded_wind.hpp"
#include "drivers/mqtt/mqtt_payload.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/reading_limit.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "drivers/sensor/secret_source.hpp"
#include "drivers/sensor/speed_unit.hpp"

namespace yuragi::drivers::mqtt {
namespace {

/// A look at the clock at least so often.
constexpr Nanoseconds kMqttWait = std::chrono::milliseconds(250);

struct MqttPreset {
  std::string_view name;
  std::string_view topic;
  std::string_view speed;
  std::string_view direction;
  std::string_view gust;
  std::string_view unit;
};
constexpr std::array<MqttPreset, 4> kMqttPresets = {
    {{"number", "", "", "", "", "m/s"},
     {"tasmota", "tele/+/SENSOR", "/TX23/Speed/Act", "/TX23/Dir/Deg", "/TX23/Speed/Max", "km/h"},
     {"rtl_433", "rtl_433/+/events", "/wind_avg_m_s", "/wind_dir_deg", "/wind_max_m_s", "m/s"},
     {"windnerd", "", "/wind_instant_speed", "/wind_instant_dir", "", "m/s"}}};
constexpr std::array<std::string_view, 4> kMqttPresetNames = {"number", "tasmota", "rtl_433", "windnerd"};
constexpr std::array<std::string_view, 6> kMqttUnits = {"preset", "m/s", "km/h", "kn", "mph", "ft/s"};

const std::array kMqttParameters = {
    Parameter{
        .name = "host", .unit = "", .default_value = std::string("127.0.0.1"), .help = "the broker's name or address"},
    Parameter{.name = "port",
              .unit = "",
              .default_value = std::int64_t{0},
              .min = 0,
              .max = 65535,
              .help = "the broker's port; 0 takes 1883, and 8883 with TLS"},
    Parameter{.name = "user", .unit = "", .default_value = std::string(""), .help = "the user name; empty: none"},
    Parameter{.name = "password",
              .unit = "",
              .default_value = Secret(),
              .help = "the user's password; or one of password_file and password_env, which keep it out of this file"},
    Parameter{.name = "password_file",
              .unit = "",
              .default_value = std::string(""),
              .help = "a file that holds the password, at most 4096 bytes; its mode should be 0640 or stricter",
              .is_secret_file = true},
    Parameter{.name = "password_env",
              .unit = "",
              .default_value = std::string(""),
              .help = "the environment variable that holds the password"},
    Parameter{.name = "tls", .unit = "", .default_value = false, .help = "use TLS, and verify the broker"},
    Parameter{.name = "ca_file",
              .unit = "",
              .default_value = std::string(""),
              .help = "the CA certificate (PEM) of the broker; empty: those of the system"},
    Parameter{.name = "preset",
              .unit = "",
              .default_value = std::string("number"),
              .help = "settings for a common publisher; topics, paths and unit that are set override them",
              .choices = kMqttPresetNames},
    Parameter{
        .name = "topic",
        .unit = "",
        .default_value = std::string(""),
        .help = "the topic of the speed, and of quantities without a topic of their own; + matches any level; at most "
                "100 readings a second are taken, of messages of at most 64 KiB"},
    Parameter{.name = "speed_path",
              .unit = "",
              .default_value = std::string(""),
              .help = "JSON pointer to the speed, such as /TX23/Speed/Act; empty takes the preset's"},
    Parameter{
        .name = "direction_topic", .unit = "", .default_value = std::string(""), .help = "the direction's own topic"},
    Parameter{.name = "direction_path",
              .unit = "",
              .default_value = std::string(""),
              .help = "JSON pointer to the direction in degrees; empty takes the preset's"},
    Parameter{.name = "gust_topic", .unit = "", .default_value = std::string(""), .help = "the gust's own topic"},
    Parameter{.name = "gust_path",
              .unit = "",
              .default_value = std::string(""),
              .help = "JSON pointer to the gust; empty takes the preset's"},
    Parameter{.name = "speed_unit",
              .unit = "",
              .default_value = std::string("preset"),
              .help = "the unit of speed and gust; \"preset\" takes the preset's",
              .choices = kMqttUnits},
    Parameter{.name = "hold",
              .unit = "s",
              .default_value = 60.0,
              .min = 0.1,
              .max = 86400.0,
              .help = "a direction or gust from a topic of its own is used for this long"},
    Parameter{.name = "silence",
              .unit = "s",
              .default_value = 900.0,
              .min = 0.1,
              .max = 86400.0,
              .help = "without a message for this long the publisher counts as stopped"},
    Parameter{.name = "on_change",
              .unit = "",
              .default_value = false,
              .help =
                  "the publisher speaks on change only (Home Assistant's statestream): a silence says that the wind "
                  "is unchanged, for as long as `silence`, which has to be longer than the longest calm"},
    Parameter{.name = "keep_alive",
              .unit = "s",
              .default_value = std::int64_t{15},
              .min = 5,
              .max = 3600,
              .help = "a broker that sends nothing for this long is pinged"},
};

/// Where one quantity comes from: a topic of its own, or the speed's.
struct MqttSource {
  std::string topic;   ///< empty: this quantity is not published
  PayloadPlace place;  ///< in its messages
};

struct MqttSettings {
  bus::MqttSubscription subscription;
  MqttSource speed;
  MqttSource direction;
  MqttSource gust;
  double metres_per_second = 1.0;
  Nanoseconds hold = std::chrono::seconds(60);
  Nanoseconds silence = std::chrono::minutes(15);
};

/// A value from a topic of its own, and when it came.
struct HeldValue {
  std::optional<double> value;
  MonoTime since{};
};

class MqttSensor final : public sensor::ReopeningSensor {
 public:
  explicit MqttSensor(MqttSettings settings)
      : sensor::ReopeningSensor(sensor::seed_of(settings.subscription.host + settings.speed.topic)),
        settings_(std::move(settings)),
        where_(fmt::format("topic {} of MQTT broker {}:{}", settings_.speed.topic, settings_.subscription.host,
                           settings_.subscription.port)),
        client_(bus::make_mqtt_client(settings_.subscription)) {}

  void interrupt() noexcept override { client_->interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override {
    if (const auto connected = client_->connect(); !connected) return connected.error();
    direction_ = {};
    gust_ = {};
    has_received_ = false;
    received_at_ = clock.now().mono;
    return received_at_;
  }

  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::SensorSink& sink) override {
    if (!has_received_) report_unusable(sink, "waits for wind on " + where_ + ": retained messages do not count");
    bus::MqttMessage message;
    const bus::MqttStatus status = client_->receive(message, kMqttWait);
    const Instant now = clock.now();
    if (status == bus::MqttStatus::kInterrupted) return Failure{"interrupted"};
    if (status == bus::MqttStatus::kLost) return Failure{client_->trouble()};
    if (status == bus::MqttStatus::kMessage) take(message, now, sink);
    if (now.mono - received_at_ >= settings_.silence) {
      has_received_ = true;  // the status now reports more than waiting
      report_unusable(
          sink, fmt::format("no wind has been received on {} for {:g} s: check that its publisher is running", where_,
                            seconds(settings_.silence)));
    }
    return now.mono;
  }

  void close() noexcept override { client_->disconnect(); }

 private:
  void take(const bus::MqttMessage& message, Instant now, sensor::SensorSink& sink) {
    sink.raw(sensor::RawDirection::kReceived, message.payload);
    if (message.is_too_long) return sink.refused(decode::Refusal::kMalformed);
    if (message.is_retained) return sink.refused(decode::Refusal::kInvalid);
    const std::string_view payload(reinterpret_cast<const char*>(message.payload.data()), message.payload.size());

    // A direction and a gust are kept until the next speed; one that cannot be read still replaces the last one.
    for (const auto& [source, held] : {std::pair{&settings_.direction, &direction_}, {&settings_.gust, &gust_}}) {
      if (!bus::mqtt_topic_matches(message.topic, source->topic)) continue;
      const auto number = number_in(payload, source->place);
      *held = {number ? *number : std::nullopt, now.mono};
      if (!number && source->topic != settings_.speed.topic) sink.refused(number.error());
    }
    if (bus::mqtt_topic_matches(message.topic, settings_.speed.topic)) take_speed(payload, now, sink);
  }

  void take_speed(std::string_view payload, Instant now, sensor::SensorSink& sink) {
    const auto speed = number_in(payload, settings_.speed.place);
    if (!speed) return sink.refused(speed.error());
    if (!*speed) return sink.refused(decode::Refusal::kNotMine);
    decode::DecodedWind wind;
    wind.speed_m_s = **speed * settings_.metres_per_second;
    if (const auto gust = still_held(gust_, now)) wind.gust_m_s = *gust * settings_.metres_per_second;
    if (const auto direction_deg = still_held(direction_, now)) {
      wind.direction_deg = decode::wrapped_direction_deg(*direction_deg);
      if (!wind.direction_deg) return sink.refused(decode::Refusal::kImplausible);
    }
    const auto plausible = decode::checked(wind);
    if (!plausible) return sink.refused(plausible.error());
    if (!limit_.admits(now.mono)) return sink.refused(decode::Refusal::kTooFrequent);

    has_received_ = true;
    received_at_ = now.mono;
    report_connected(sink, where_);
    sink.reading({.time = now,
                  .speed_m_s = *plausible->speed_m_s,
                  .direction_deg = plausible->direction_deg,
                  .gust_m_s = plausible->gust_m_s,
                  .quality = wind::ReadingQuality::kGood});
  }

  std::optional<double> still_held(const HeldValue& held, Instant now) const {
    return now.mono - held.since <= settings_.hold ? held.value : std::nullopt;
  }

  MqttSettings settings_;
  std::string where_;
  std::unique_ptr<bus::MqttClient> client_;
  HeldValue direction_;
  HeldValue gust_;
  sensor::ReadingLimit limit_;
  bool has_received_ = false;  // of the wind, since it connected
  MonoTime received_at_{};     // or since when it could have
};

/// Throws, naming the setting, for what can be neither subscribed to nor found.
void check_source(std::string_view name, const MqttSource& source) {
  if (!source.topic.empty() && !bus::is_mqtt_filter(source.topic)) {
    throw std::runtime_error(
        fmt::format("{}topic: \"{}\" is not a topic; # is allowed at the end only, and + in place of a whole level",
                    name, source.topic));
  }
  if (!is_json_pointer(source.place.pointer)) {
    throw std::runtime_error(
        fmt::format("{}path: \"{}\" is not a JSON pointer, which begins with a slash, as in /TX23/Speed/Act",
                    name.empty() ? "speed_" : name, source.place.pointer));
  }
}

/// The password from the one place that is given; empty: none. Throws, naming the setting.
Secret password_of(const ParameterValues& values) {
  const Secret& password = values.secret("password");
  const std::string& file = values.text("password_file");
  const std::string& variable = values.text("password_env");
  if (static_cast<int>(!password.is_empty()) + static_cast<int>(!file.empty()) + static_cast<int>(!variable.empty()) >
      1)
    throw std::runtime_error(
        "password: is given more than once; allowed: one of password, password_file, password_env");
  const auto found = [](std::string_view name, const Result<Secret, Failure>& secret) {
    if (!secret) throw std::runtime_error(fmt::format("{}: {}", name, secret.error().message));
    return *secret;
  };
  if (!file.empty()) return found("password_file", sensor::secret_in_file(file));
  if (!variable.empty()) return found("password_env", sensor::secret_in_environment(variable));
  return password;
}

MqttSettings mqtt_settings_of(const ParameterValues& values) {
  const auto preset = std::ranges::find(kMqttPresets, values.text("preset"), &MqttPreset::name);
  const auto text_or = [&values](std::string_view name, std::string_view otherwise) {
    return values.text(name).empty() ? std::string(otherwise) : values.text(name);
  };
  MqttSettings settings;
  settings.speed = MqttSource{text_or("topic", preset->topic), {text_or("speed_path", preset->speed)}};
  if (settings.speed.topic.empty())
    throw std::runtime_error("topic: is missing; give the topic that the speed is published on");

  // Without a topic of its own a quantity comes with the speed, if its place in the message is configured.
  const auto source_of = [&](std::string_view topic, std::string_view path, std::string_view preset_path) {
    MqttSource source = {values.text(topic), {text_or(path, preset_path)}};
    if (source.topic.empty() && source.place.is_json()) source.topic = settings.speed.topic;
    return source;
  };
  settings.direction = source_of("direction_topic", "direction_path", preset->direction);
  settings.gust = source_of("gust_topic", "gust_path", preset->gust);
  const std::string& unit = values.text("speed_unit");
  settings.metres_per_second = sensor::metres_per_second_in(unit == "preset" ? preset->unit : unit);
  settings.hold = from_seconds(values.number("hold"));
  settings.silence = from_seconds(values.number("silence"));

  bus::MqttSubscription& subscription = settings.subscription;
  subscription.host = values.text("host");
  subscription.uses_tls = values.flag("tls");
  const std::int64_t port = values.integer("port");
  subscription.port = static_cast<std::uint16_t>(port != 0 ? port : subscription.uses_tls ? 8883 : 1883);
  subscription.user = values.text("user");
  subscription.password = password_of(values);
  subscription.ca_file = values.text("ca_file");
  subscription.keep_alive = std::chrono::seconds(values.integer("keep_alive"));
  for (const MqttSource* const source : {&settings.speed, &settings.direction, &settings.gust}) {
    const bool is_new = std::ranges::count(subscription.topics, source->topic) == 0;
    if (!source->topic.empty() && is_new) subscription.topics.push_back(source->topic);
  }
  return settings;
}

std::unique_ptr<sensor::Sensor> open_mqtt(const ParameterValues& values) {
  MqttSettings settings = mqtt_settings_of(values);
  check_source("", settings.speed);
  check_source("direction_", settings.direction);
  check_source("gust_", settings.gust);
  if (settings.subscription.host.empty()) throw std::runtime_error("host: is empty; give the broker's name or address");
  return std::make_unique<MqttSensor>(std::move(settings));
}

double mqtt_unchanged_for_s(const ParameterValues& values) {
  return values.flag("on_change") ? values.number("silence") : 0.0;
}

}  // namespace

extern const sensor::DriverDescription kMqttDriver;
const sensor::DriverDescription kMqttDriver{
    .name = "mqtt",
    .summary = "wind that is published on an MQTT broker, as a number or in JSON",
    .parameters = kMqttParameters,
    .open = open_mqtt,
    .unchanged_for_s = mqtt_unchanged_for_s};

}  // namespace yuragi::drivers::mqtt
