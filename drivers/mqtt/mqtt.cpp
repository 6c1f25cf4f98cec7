// Wind that is published on an MQTT broker (OASIS, "MQTT Version 3.1.1", 2014): a home's weather station, a gateway, a
// microcontroller. Speed, direction and gust may come in one JSON message or each on a topic of its own. Common
// publishers have a preset (mqtt_preset.cpp), which single settings override.
//
// A retained message was kept by the broker for later subscribers: its age is unknown, and it is never taken for the
// live wind.
#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "drivers/bus/mqtt_client.hpp"
#include "drivers/decode/json_pointer.hpp"
#include "drivers/decode/speed_units.hpp"
#include "drivers/mqtt/mqtt_payload.hpp"
#include "drivers/mqtt/mqtt_preset.hpp"
#include "drivers/mqtt/station_identity.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/held_wind.hpp"
#include "drivers/sensor/reading_limit.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "drivers/sensor/secret_source.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "engine/base/address.hpp"
#include "engine/base/fields.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::drivers::mqtt {
namespace {

/// The clock is checked at least this often.
constexpr Nanoseconds kMqttWait = std::chrono::milliseconds(250);

using bus::MqttSubscription;

constexpr std::array<std::string_view, 6> kMqttUnits = {"preset", "m/s", "km/h", "kn", "mph", "ft/s"};

/// One place in a message where a quantity can stand.
struct Place {
  std::string pointer;             ///< a JSON pointer; empty: the payload is the number
  std::optional<double> factor{};  ///< of a speed to m/s, if the key has its unit; nullopt: unit_of() the message

  bool is_json() const noexcept { return !pointer.empty(); }
};

/// Where one quantity comes from: a topic of its own, or the speed's. Of several places the first that a message has
/// counts.
struct Source {
  std::string topic;  ///< empty: this quantity is not published
  std::vector<Place> places;
};

struct Settings {
  bus::MqttSubscription subscription;
  const Preset* preset = nullptr;
  Source speed;
  Source direction;
  Source gust;
  StationIdentity station;         ///< which ones are read
  double metres_per_second = 1.0;  ///< if the message does not have it
  bool has_own_unit = false;       ///< it was set, and also holds if the message's unit is unknown
  Nanoseconds hold = std::chrono::seconds(60);
  Nanoseconds silence = std::chrono::minutes(15);
};

/// The settings as they are written: without the preset's.
struct Keys {
  Settings settings;
  std::string speed_path;
  std::string direction_path;
  std::string gust_path;
  std::string speed_unit;
  bool reports_on_change = false;

  bool has_own_unit() const { return speed_unit != kMqttUnits[0]; }
};

auto of(auto... members) {
  return member_of(&Keys::settings, members...);
}

const Fields<Keys> kMqttFields = {
    {{.name = "host", .default_value = std::string("127.0.0.1"), .help = "the broker's name or address"},
     of(&Settings::subscription, &MqttSubscription::host)},
    {{"port", "", std::int64_t{0}, 0, 65535, "the broker's port; 0: 1883, with TLS 8883"},
     of(&Settings::subscription, &MqttSubscription::port)},
    {{.name = "user", .default_value = std::string(""), .help = "the user name; empty: none"},
     of(&Settings::subscription, &MqttSubscription::user)},
    Parameter{.name = "password",
              .default_value = Secret(),
              .help = "the user's password; or one of password_file and password_env, which keep it out of this file"},
    Parameter{.name = "password_file",
              .default_value = std::string(""),
              .help = "a file that holds the password, at most 4096 bytes; its mode should be 0640 or stricter",
              .is_secret_file = true},
    Parameter{.name = "password_env",
              .default_value = std::string(""),
              .help = "the environment variable that holds the password"},
    {{.name = "tls", .default_value = false, .help = "use TLS, and verify the broker"},
     of(&Settings::subscription, &MqttSubscription::uses_tls)},
    {{.name = "ca_file",
      .default_value = std::string(""),
      .help = "the CA certificate (PEM) of the broker; empty: those of the system"},
     of(&Settings::subscription, &MqttSubscription::ca_file)},
    {{.name = "preset",
      .default_value = std::string("number"),
      .help = "settings for a common publisher; topics, paths and unit that are set override them",
      .choices = kMqttPresetNames},
     of(&Settings::preset),
     [](const std::string& name) { return &mqtt_preset_of(name); }},
    {{.name = "model",
      .default_value = std::string(""),
      .help = "with rtl_433: the model of the station to read, such as Acurite-5n1; empty: any. If the topic has "
              "several stations, the first one received is read, until it is silent"},
     of(&Settings::station, &StationIdentity::model)},
    {{.name = "id",
      .default_value = std::string(""),
      .help = "with rtl_433: the id of the station to read; empty: any. Many stations change their id with their "
              "batteries"},
     of(&Settings::station, &StationIdentity::id)},
    {{.name = "channel",
      .default_value = std::string(""),
      .help = "with rtl_433: the channel of the station to read, such as A or 1; empty: any"},
     of(&Settings::station, &StationIdentity::channel)},
    {{.name = "topic",
      .default_value = std::string(""),
      .help = "the topic of the speed, and of quantities without a topic of their own; + matches any level; at most "
              "100 readings a second are taken, of messages of at most 64 KiB"},
     of(&Settings::speed, &Source::topic)},
    {{.name = "speed_path",
      .default_value = std::string(""),
      .help = "JSON pointer to the speed, such as /TX23/Speed/Act; empty: the preset's"},
     &Keys::speed_path},
    {{.name = "direction_topic", .default_value = std::string(""), .help = "the direction's own topic"},
     of(&Settings::direction, &Source::topic)},
    {{.name = "direction_path",
      .default_value = std::string(""),
      .help = "JSON pointer to the direction, in degrees or as a compass point (NW); empty: the preset's"},
     &Keys::direction_path},
    {{.name = "gust_topic", .default_value = std::string(""), .help = "the gust's own topic"},
     of(&Settings::gust, &Source::topic)},
    {{.name = "gust_path", .default_value = std::string(""), .help = "JSON pointer to the gust; empty: the preset's"},
     &Keys::gust_path},
    {{.name = "speed_unit",
      .default_value = std::string("preset"),
      .help = "the unit of speed and gust, if the message has none (Tasmota's SpeedUnit, rtl_433's keys); \"preset\": "
              "the preset's",
      .choices = kMqttUnits},
     &Keys::speed_unit},
    {{"hold", "s", 60.0, 0.1, 86400.0, "a direction or gust is used for this long with speeds that come without one"},
     of(&Settings::hold),
     from_seconds},
    {{"silence", "s", 900.0, 0.1, 86400.0, "without a message for this long the publisher counts as stopped"},
     of(&Settings::silence),
     from_seconds},
    {{.name = "on_change",
      .default_value = false,
      .help = "the publisher sends only changes (Home Assistant's statestream): without messages the wind counts as "
              "unchanged, for as long as `silence`, which must be longer than the longest calm"},
     &Keys::reports_on_change},
    {{"keep_alive", "s", std::int64_t{15}, 5, 3600, "a broker that sends nothing for this long is pinged"},
     of(&Settings::subscription, &MqttSubscription::keep_alive),
     [](std::int64_t time_s) { return std::chrono::seconds(time_s); }},
};

/// A direction or gust that a message has: without a value if the publisher reports that it has none.
struct SentValue {
  std::optional<double> value = {};
  bool is_unreadable = false;
};

/// Makes a received text printable for the status.
std::string shown(const std::string& text) {
  std::string printable = text;
  make_printable(printable);
  return shortened(printable, 20);
}

/// Returns true if any of the sources reads JSON.
PayloadForm form_of(const Settings& settings) {
  for (const Source* const source : {&settings.speed, &settings.direction, &settings.gust}) {
    if (std::ranges::any_of(source->places, &Place::is_json)) return PayloadForm::kJson;
  }
  return PayloadForm::kText;
}

/// Returns the first of the source's places that the message has; nullptr if it has none.
const Place* place_in(const Payload& payload, const Source& source) {
  const auto place =
      std::ranges::find_if(source.places, [&](const auto& each) { return !payload.lacks(each.pointer); });
  return place == source.places.end() ? nullptr : &*place;
}

class Sensor final : public sensor::ReopeningSensor {
 public:
  explicit Sensor(Settings settings)
      : sensor::ReopeningSensor(sensor::seed_of(settings.subscription.host + settings.speed.topic)),
        settings_(std::move(settings)),
        where_(fmt::format("topic {} of MQTT broker {}:{}", settings_.speed.topic, settings_.subscription.host,
                           settings_.subscription.port)),
        client_(bus::make_mqtt_client(settings_.subscription)),
        form_(form_of(settings_)),
        held_(settings_.hold),
        stations_(settings_.silence) {}

  void interrupt() noexcept override { client_->interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override {
    if (const auto connected = client_->connect(); !connected) return connected.error();
    held_.clear();
    note_.clear();
    stations_.restart();
    has_received_ = false;
    received_at_ = clock.now().mono;
    return received_at_;
  }

  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override {
    if (!has_received_)
      report_unusable(sink, "waits for wind on " + where_ + ": retained messages do not count" + note_);
    bus::MqttMessage message;
    const bus::MqttStatus status = client_->receive(message, kMqttWait);
    const Instant now = clock.now();
    if (status == bus::MqttStatus::kInterrupted) return Failure{"interrupted"};
    if (status == bus::MqttStatus::kLost) return Failure{client_->trouble()};
    if (status == bus::MqttStatus::kMessage) take(message, now, sink);
    if (now.mono - received_at_ >= settings_.silence) {
      has_received_ = true;  // the status now reports more than waiting
      report_unusable(
          sink, fmt::format("no wind has been received on {} for {:g} s: check that its publisher is running{}", where_,
                            seconds(settings_.silence), note_));
    }
    return now.mono;
  }

  void close() noexcept override { client_->disconnect(); }

 private:
  void take(const bus::MqttMessage& message, Instant now, sensor::Sink& sink) {
    sink.raw(sensor::RawDirection::kReceived, message.payload);
    if (message.is_too_long) return sink.refused(decode::Refusal::kMalformed);
    if (message.is_retained) return sink.refused(decode::Refusal::kInvalid);
    const Payload payload({reinterpret_cast<const char*>(message.payload.data()), message.payload.size()}, form_);
    if (bus::mqtt_topic_matches(message.topic, settings_.speed.topic)) {
      if (settings_.speed.places.front().is_json() && payload.json().is_discarded())
        return sink.refused(decode::Refusal::kMalformed);
      if (!is_of_the_station(payload, now.mono)) return sink.refused(decode::Refusal::kNotMine);
    }
    const auto unit = unit_of(payload);
    if (!unit) return sink.refused(unit.error());

    const auto direction = value_in(settings_.direction, message.topic, payload, std::nullopt, sink);
    if (direction) hold_direction(*direction, now.mono, sink);
    const auto gust = value_in(settings_.gust, message.topic, payload, *unit, sink);
    if (gust && !held_.hold_gust(gust->value, now.mono)) return sink.refused(decode::Refusal::kImplausible);
    if (!bus::mqtt_topic_matches(message.topic, settings_.speed.topic)) return;
    const Place* const speed = place_in(payload, settings_.speed);
    const bool names_it = speed != nullptr || settings_.preset->names_stations;
    const bool has_quantities = names_it && take_quantities(payload, now, sink);
    if (speed != nullptr)
      return take_speed(payload.number_at(speed->pointer), speed->factor.value_or(*unit), now, sink);
    if (!direction && !gust && !has_quantities) sink.refused(decode::Refusal::kNotMine);
  }

  /// Returns true if the message comes from the selected station; always true if publishers name none.
  bool is_of_the_station(const Payload& payload, MonoTime now) {
    if (!settings_.preset->names_stations || !payload.json().is_object()) return true;
    const StationIdentity station = station_of(payload);
    if (!settings_.station.covers(station)) {
      if (note_.empty())
        note_ = "; it receives " + describe(station) + ", but model, id or channel select another station";
      return false;
    }
    const bool has_wind = place_in(payload, settings_.speed) != nullptr || place_in(payload, settings_.gust) != nullptr;
    return has_wind ? stations_.offer(station, now) : stations_.is_read(station);
  }

  /// Returns the factor to m/s of this message's speeds; kInvalid if its unit is unknown, and none is set.
  Result<double, decode::Refusal> unit_of(const Payload& payload) {
    if (settings_.preset->unit_pointer.empty()) return settings_.metres_per_second;
    const auto word = payload.text_at(std::string(settings_.preset->unit_pointer));
    if (!word) return settings_.metres_per_second;
    if (const auto known = decode::speed_unit_of_word(*word)) return known->metres_per_second;
    if (settings_.has_own_unit) return settings_.metres_per_second;
    note_ = fmt::format("; the unit of its speed, \"{}\", is unknown: set speed_unit", shown(*word));
    return decode::Refusal::kInvalid;
  }

  /// Returns a direction (without `unit`) or a gust of this message: without a value if that cannot be read, or is sent
  /// as unknown; nullopt if the message has no place for it.
  std::optional<SentValue> value_in(const Source& source, const std::string& topic, const Payload& payload,
                                    std::optional<double> unit, sensor::Sink& sink) const {
    if (!bus::mqtt_topic_matches(topic, source.topic)) return std::nullopt;
    const Place* const place = place_in(payload, source);
    if (place == nullptr) return std::nullopt;
    const auto number = unit ? payload.number_at(place->pointer) : payload.direction_at(place->pointer);
    if (!number) {
      if (source.topic != settings_.speed.topic) sink.refused(number.error());
      return SentValue{.value = std::nullopt, .is_unreadable = number.error() != decode::Refusal::kInvalid};
    }
    if (!*number) return SentValue{.value = std::nullopt};
    return SentValue{.value = **number * place->factor.value_or(unit.value_or(1.0))};
  }

  /// A direction that is impossible, or cannot be read, is none; the speed beside it counts.
  void hold_direction(const SentValue& sent, MonoTime now, sensor::Sink& sink) {
    if (sent.is_unreadable) return held_.lose_direction(now);
    if (!held_.hold_direction(sent.value, now)) sink.refused(decode::Refusal::kImplausible);
  }

  bool take_quantities(const Payload& payload, Instant now, sensor::Sink& sink) const {
    if (settings_.preset->quantities == nullptr) return false;
    auto quantities = settings_.preset->quantities(payload);
    if (!quantities) return false;
    quantities->time = now;
    sink.quantities(*quantities);
    return true;
  }

  void take_speed(const Result<std::optional<double>, decode::Refusal>& speed, double metres_per_second, Instant now,
                  sensor::Sink& sink) {
    if (!speed) return sink.refused(speed.error());
    if (!*speed) return sink.refused(decode::Refusal::kNotMine);
    const auto reading = held_.reading_of(**speed * metres_per_second, now);
    if (!reading) return sink.refused(reading.error());
    if (!limit_.admits(now.mono)) return sink.refused(decode::Refusal::kTooFrequent);

    has_received_ = true;
    received_at_ = now.mono;
    report_connected(sink, where_ + stations_.warning(now.mono));
    sink.reading(*reading);
  }

  Settings settings_;
  std::string where_;
  std::unique_ptr<bus::MqttClient> client_;
  PayloadForm form_;
  sensor::HeldWind held_;
  StationChoice stations_;
  std::string note_;  // why messages cannot be read, for the status; empty: they can
  sensor::ReadingLimit limit_;
  bool has_received_ = false;  // of the wind, since it connected
  MonoTime received_at_{};     // or since when wind could have been received
};

/// Throws, naming the setting, if a topic cannot be subscribed to, or a value not found.
void check_source(std::string_view name, const Source& source) {
  if (!source.topic.empty() && !bus::is_mqtt_filter(source.topic)) {
    throw std::runtime_error(
        fmt::format("{}topic: \"{}\" is not a topic; # is allowed only at the end, and + only as a whole level", name,
                    source.topic));
  }
  for (const Place& place : source.places) {
    if (decode::is_json_pointer(place.pointer)) continue;
    throw std::runtime_error(
        fmt::format("{}path: \"{}\" is not a JSON pointer, which begins with a slash, as in /TX23/Speed/Act",
                    name.empty() ? "speed_" : name, place.pointer));
  }
}

/// Returns the places of a quantity: the one that is set, or the preset's. A known key of a speed gives its unit,
/// unless `own_unit` was set with the path.
std::vector<Place> places_of(const std::string& path, std::span<const PresetPlace> known, bool has_own_unit) {
  std::vector<Place> places;
  for (const PresetPlace& place : known) {
    if (!path.empty() && path != place.pointer) continue;
    const auto said = path.empty() || !has_own_unit ? decode::speed_unit_of_word(place.unit) : std::nullopt;
    places.push_back({.pointer = std::string(place.pointer),
                      .factor = said ? std::optional(said->metres_per_second) : std::nullopt});
  }
  if (places.empty() && !path.empty()) places.push_back({.pointer = path});
  return places;
}

Source speed_source_of(const Keys& keys) {
  const Preset& preset = *keys.settings.preset;
  const std::string& topic = keys.settings.speed.topic;
  Source speed = {.topic = topic.empty() ? std::string(preset.topic) : topic,
                  .places = places_of(keys.speed_path, preset.speed, keys.has_own_unit())};
  if (speed.topic.empty()) throw std::runtime_error("topic: is missing; give the topic that the speed is published on");
  if (speed.places.empty()) speed.places.emplace_back();
  return speed;
}

std::uint16_t broker_port_of(const MqttSubscription& subscription) {
  const std::uint16_t usual = subscription.uses_tls ? 8883 : 1883;
  return subscription.port != 0 ? subscription.port : usual;
}

std::vector<sensor::Endpoint> mqtt_endpoints(const ParameterValues& values) {
  const Keys keys = kMqttFields.of(values);
  const MqttSubscription& broker = keys.settings.subscription;
  return {{.kind = sensor::EndpointKind::kBroker, .name = to_string(Address{broker.host, broker_port_of(broker)})}};
}

Settings mqtt_settings_of(const ParameterValues& values) {
  const Keys keys = kMqttFields.of(values);
  Settings settings = keys.settings;
  const Preset& preset = *settings.preset;
  settings.has_own_unit = keys.has_own_unit();
  settings.metres_per_second =
      sensor::metres_per_second_in(settings.has_own_unit ? std::string_view(keys.speed_unit) : preset.unit);

  settings.speed = speed_source_of(keys);

  // Without a topic of its own a quantity comes with the speed, if its place in the message is known.
  const auto complete = [&](Source& source, const std::string& path, std::span<const PresetPlace> known) {
    source.places = places_of(path, known, settings.has_own_unit);
    if (source.topic.empty() && !source.places.empty()) source.topic = settings.speed.topic;
    if (source.places.empty()) source.places.emplace_back();
  };
  complete(settings.direction, keys.direction_path, preset.direction);
  complete(settings.gust, keys.gust_path, preset.gust);
  if (!settings.station.is_empty() && !preset.names_stations)
    throw std::runtime_error("model, id, channel: are only for preset \"rtl_433\"; leave them out");

  MqttSubscription& subscription = settings.subscription;
  subscription.port = broker_port_of(subscription);
  subscription.password = sensor::secret_of(values, "password");
  for (const Source* const source : {&settings.speed, &settings.direction, &settings.gust}) {
    const bool is_new = std::ranges::count(subscription.topics, source->topic) == 0;
    if (!source->topic.empty() && is_new) subscription.topics.push_back(source->topic);
  }
  return settings;
}

std::unique_ptr<sensor::Sensor> open_mqtt(const ParameterValues& values) {
  Settings settings = mqtt_settings_of(values);
  check_source("", settings.speed);
  check_source("direction_", settings.direction);
  check_source("gust_", settings.gust);
  if (settings.subscription.host.empty()) throw std::runtime_error("host: is empty; give the broker's name or address");
  return std::make_unique<Sensor>(std::move(settings));
}

/// Returns true if every topic of the filter `narrow` is one of `wide`, another filter.
bool topic_covers(const std::string& wide, const std::string& narrow) {
  std::string topic = narrow;
  std::ranges::replace_if(
      topic, [](char c) { return c == '+' || c == '#'; }, '?');
  return bus::mqtt_topic_matches(topic, wide);
}

sensor::ValueSelection mqtt_selection(const ParameterValues& values) {
  const Keys keys = kMqttFields.of(values);
  const Source speed = speed_source_of(keys);
  const StationIdentity& station = keys.settings.station;
  const auto pointer_of = [](const Place& place) { return place.is_json() ? place.pointer : "the whole message"; };
  std::string pointers;
  for (const Place& place : speed.places) pointers += (pointers.empty() ? "" : ",") + pointer_of(place);
  return {.device = "MQTT broker " + bus::device_of({.kind = bus::BytePortKind::kTcpClient,
                                                     .host = keys.settings.subscription.host,
                                                     .port = broker_port_of(keys.settings.subscription)}),
          .device_keys = "host, port",
          .parts = {{.key = "topic", .value = speed.topic, .covers = topic_covers},
                    {.key = "speed_path", .value = std::move(pointers), .covers = sensor::list_covers},
                    {.key = "model", .value = station.model},
                    {.key = "id", .value = station.id},
                    {.key = "channel", .value = station.channel}}};
}

double mqtt_unchanged_for_s(const ParameterValues& values) {
  const Keys keys = kMqttFields.of(values);
  return keys.reports_on_change ? seconds(keys.settings.silence) : 0.0;
}

}  // namespace

extern const sensor::DriverDescription kMqttDriver;
const sensor::DriverDescription kMqttDriver{
    .name = "mqtt",
    .summary = "wind that is published on an MQTT broker, as a number or in JSON",
    .parameters = kMqttFields.parameters(),
    .open = open_mqtt,
    .endpoints = mqtt_endpoints,
    .selection = mqtt_selection,
    .unchanged_for_s = mqtt_unchanged_for_s,
    .simulated = [](const ParameterValues&) -> Result<sensor::SimulatedDevice, Failure> {
      return Failure{"the driver mqtt has no simulated device, because that would also need a broker"};
    }};

}  // namespace yuragi::drivers::mqtt
