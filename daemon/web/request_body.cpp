#include "daemon/web/request_body.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/base/json_text.hpp"

namespace yuragi::daemon::web {
namespace {

constexpr int kDeepest = 4;  ///< of a body; deeper ones are no request of ours

/// Takes the keys of an object one by one. The first mistake is kept.
class Body {
 public:
  explicit Body(nlohmann::json object) : object_(std::move(object)) {}
  explicit Body(std::string_view text) {
    const auto is_shallow = [](int depth, nlohmann::json::parse_event_t /*event*/, nlohmann::json& /*parsed*/) {
      return depth <= kDeepest;
    };
    object_ = nlohmann::json::parse(text, is_shallow, false);
    if (!object_.is_object()) mistake_ = "this is not a JSON object";
  }

  std::string text(const char* key, std::string otherwise) {
    const nlohmann::json* value = take(key);
    if (value == nullptr) return otherwise;
    if (value->is_string() && value->get_ref<const std::string&>().size() <= wire::kMaxTextBytes) return *value;
    refuse(key, fmt::format("a text of at most {} bytes", wire::kMaxTextBytes));
    return otherwise;
  }
  bool flag(const char* key, bool otherwise) {
    const nlohmann::json* value = take(key);
    if (value == nullptr || value->is_boolean()) return value == nullptr ? otherwise : value->get<bool>();
    refuse(key, "true or false");
    return otherwise;
  }
  double number(const char* key, double otherwise, double least, double most) {
    const nlohmann::json* value = take(key);
    if (value == nullptr) return otherwise;
    if (value->is_number() && value->get<double>() >= least && value->get<double>() <= most)
      return value->get<double>();
    refuse(key, fmt::format("a number from {} to {}", least, most));
    return otherwise;
  }
  /// Without the key: nullopt.
  std::optional<double> optional_number(const char* key, double least, double most) {
    if (!object_.is_object() || !object_.contains(key)) return std::nullopt;
    return number(key, least, least, most);
  }
  /// Null: nullopt.
  std::optional<double> number_or_null(const char* key, double otherwise, double least, double most) {
    if (object_.is_object() && object_.contains(key) && object_[key].is_null()) {
      object_.erase(key);
      return std::nullopt;
    }
    return number(key, otherwise, least, most);
  }
  std::vector<std::string> texts(const char* key, std::size_t most) {
    const nlohmann::json* value = take(key);
    if (value == nullptr) return {};
    std::vector<std::string> all;
    bool is_sound = value->is_array() && value->size() <= most;
    for (const nlohmann::json& each : is_sound ? *value : nlohmann::json::array()) {
      is_sound = is_sound && each.is_string() && each.get_ref<const std::string&>().size() <= wire::kMaxTextBytes;
      if (is_sound) all.push_back(each);
    }
    if (!is_sound) refuse(key, fmt::format("a list of at most {} texts", most));
    return all;
  }
  /// The values below, as the configuration has them but without quotes.
  std::vector<std::pair<std::string, std::string>> values(const char* key, std::size_t most) {
    const nlohmann::json* value = take(key);
    if (value == nullptr) return {};
    std::vector<std::pair<std::string, std::string>> all;
    bool is_sound = value->is_object() && value->size() <= most;
    if (is_sound) {
      for (const auto& [name, each] : value->items()) {
        is_sound = is_sound && (each.is_string() || each.is_number() || each.is_boolean());
        if (is_sound) all.emplace_back(name, each.is_string() ? each.get<std::string>() : json_text(each));
        is_sound = is_sound && name.size() + all.back().second.size() <= wire::kMaxTextBytes;
      }
    }
    if (!is_sound) refuse(key, fmt::format("an object of at most {} texts, numbers, true or false", most));
    return all;
  }
  /// An object below; nullopt: there is none.
  std::optional<Body> below(const char* key) {
    const nlohmann::json* value = take(key);
    if (value == nullptr) return std::nullopt;
    if (value->is_object()) return Body(*value);
    refuse(key, "an object");
    return std::nullopt;
  }
  /// Of what has not been taken, in the order of their names.
  std::vector<std::string> keys() const {
    std::vector<std::string> all;
    for (const auto& [key, value] : object_.items()) all.push_back(key);
    return all;
  }
  void require(bool holds, const char* what) {
    if (!holds && !mistake_) mistake_ = what;
  }

  /// Nothing: all was understood.
  std::optional<Failure> mistake() {
    if (!mistake_ && !object_.empty()) mistake_ = fmt::format("{}: is not known here", object_.begin().key());
    if (!mistake_) return std::nullopt;
    return Failure{*mistake_, FailureKind::kUsage};
  }

 private:
  const nlohmann::json* take(const char* key) {
    if (!object_.is_object() || !object_.contains(key)) return nullptr;
    taken_ = std::move(object_[key]);
    object_.erase(key);
    return &taken_;
  }
  void refuse(const char* key, const std::string& allowed) {
    if (!mistake_) mistake_ = fmt::format("{}: must be {}", key, allowed);
  }

  nlohmann::json object_;
  nlohmann::json taken_;
  std::optional<std::string> mistake_;
};

struct ActionName {
  std::string_view name;
  wire::PlayerAction action;
};
constexpr double kMinHold_s = 1.0;
constexpr double kUsualHold_s = 3600.0;

/// What blackout and camera have in common.
Result<wire::HandCommand, Failure> hold_of(Body body, wire::HandPart part) {
  wire::HandCommand command{.part = part};
  command.is_release = body.flag("release", false);
  if (part == wire::HandPart::kCamera) {
    command.camera = body.text("camera", "");
    body.require(command.is_release || !command.camera.empty(), "camera: is missing: the name of a [[camera]]");
  }
  command.for_s = body.number_or_null("for_s", kUsualHold_s, kMinHold_s, wire::kMaxHandHold_s);
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return command;
}

constexpr std::array kActions = {
    ActionName{"pause", wire::PlayerAction::kPause}, ActionName{"resume", wire::PlayerAction::kResume},
    ActionName{"step", wire::PlayerAction::kStep}, ActionName{"seek", wire::PlayerAction::kSeek},
    ActionName{"rate", wire::PlayerAction::kRate}};

}  // namespace

Result<wire::Control, Failure> scene_control_of(std::string_view json) {
  Body body(json);
  wire::Control control;
  control.scene = body.text("scene", "");
  control.shown = body.flag("shown", control.shown);
  control.hide_others = body.flag("hide_others", control.hide_others);
  control.over_s = body.number("over_s", control.over_s, 0.0, wire::kMaxFade_s);
  body.require(!control.scene.empty(), "scene: is missing: the name of the scene to show or hide");
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return control;
}

Result<Pairing, Failure> pairing_of(std::string_view json) {
  Body body(json);
  Pairing pairing{.code = body.text("code", "")};
  body.require(!pairing.code.empty(), "code: is missing: what `yuragi token` shows");
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return pairing;
}

Result<Revocation, Failure> revocation_of(std::string_view json) {
  Body body(json);
  Revocation revocation{.id = body.text("revoke", "")};
  body.require(!revocation.id.empty(),
               "revoke: is missing: the id of a session, which `yuragi token --sessions` lists");
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return revocation;
}

Result<SocketWish, Failure> socket_wish_of(std::string_view json) {
  Body body(json);
  SocketWish wish;
  wish.wind_hz = body.number("wind", 0.0, 0.0, SocketWish::kMaxWindRate_hz);
  wish.status_hz = body.number("status", 0.0, 0.0, SocketWish::kMaxStatusRate_hz);
  wish.places = body.texts("places", SocketWish::kMaxPlaces);
  if (auto stream = body.below("stream")) {
    wish.stream.emplace();
    wish.stream->takes_new_scenes = true;
    wish.stream->sensors = stream->flag("sensors", false);
    wish.stream->thinning.scenes = stream->texts("scenes", wire::kMaxScenes);
    wish.stream->thinning.every = static_cast<std::uint32_t>(stream->number("every", 1.0, 1.0, wire::kMaxEvery));
    wish.stream->rate_hz = stream->number("rate", 0.0, 0.0, wire::kMaxRate_hz);
    if (auto mistake = stream->mistake()) return Failure{"stream: " + mistake->message, FailureKind::kUsage};
  }
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return wish;
}

Result<wire::ParameterCommand, Failure> parameter_command_of(std::string_view json) {
  Body body(json);
  wire::ParameterCommand command{.scene = body.text("scene", "")};
  for (auto& [key, value] : body.values("set", wire::kMaxParameterEdits)) {
    command.edits.push_back({std::move(key), std::move(value)});
  }
  for (std::string& key : body.texts("reset", wire::kMaxParameterEdits)) command.edits.push_back({std::move(key), {}});
  body.require(!command.edits.empty(), "set: is missing: the keys and their new values, or in reset keys alone");
  body.require(command.edits.size() <= wire::kMaxParameterEdits, "set, reset: too many values at once (maximum 64)");
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return command;
}

Result<wire::HandCommand, Failure> wind_by_hand_of(std::string_view json) {
  Body body(json);
  wire::HandCommand command{.part = wire::HandPart::kWind};
  command.is_release = body.flag("release", false);
  // Without these keys there is no wind: -1 stands for that.
  const double speed_m_s = body.number("speed_m_s", -1.0, 0.0, wire::kMaxHandWind_m_s);
  const double direction_deg = body.number("direction_deg", -1.0, 0.0, 360.0);
  command.for_s = body.number("for_s", 60.0, kMinHold_s, wire::kMaxHandWind_s);
  body.require(command.is_release || speed_m_s >= 0.0, "speed_m_s: is missing");
  body.require(command.is_release || direction_deg >= 0.0, "direction_deg: is missing: where the wind comes from");
  if (auto mistake = body.mistake()) return std::move(*mistake);
  command.speed_m_s = std::max(0.0, speed_m_s);
  command.direction_deg = std::max(0.0, direction_deg);
  return command;
}

Result<wire::HandCommand, Failure> blackout_of(std::string_view json) {
  return hold_of(Body(json), wire::HandPart::kBlackout);
}

Result<wire::HandCommand, Failure> camera_of(std::string_view json) {
  return hold_of(Body(json), wire::HandPart::kCamera);
}

Result<wire::ReloadCommand, Failure> reload_command_of(std::string_view json) {
  Body body(json);
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return wire::ReloadCommand{};
}

Result<settings::PageSensor, Failure> sensor_of(std::string_view json, bool has_name) {
  constexpr std::size_t kMostKeys = 64;
  Body body(json);
  settings::PageSensor sensor;
  if (has_name) {
    sensor.name = body.text("name", "");
    body.require(!sensor.name.empty(), "name: is missing: how the sensor is to be called");
  }
  sensor.driver = body.text("driver", "");
  body.require(!sensor.driver.empty(), "driver: is missing; /api/v1/drivers lists all");
  sensor.values = body.values("parameters", kMostKeys);
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return sensor;
}

Result<CalibrationOrder, Failure> calibration_order_of(std::string_view json) {
  Body body(json);
  CalibrationOrder order;
  order.calibration = body.text("calibration", "");
  order.duration_s = body.optional_number("for_s", 1.0, CalibrationOrder::kMaxDuration_s);
  order.bearing_deg = body.optional_number("bearing_deg", 0.0, 360.0);
  order.speed_m_s = body.optional_number("speed_m_s", 0.1, 100.0);
  order.reference = body.text("reference", "");
  const auto points = wind::judging::parse_calibration_curve(body.text("points", ""));
  body.require(points.has_value(), "points: must be MEASURED:TRUE in m/s, two or more with blanks between, rising");
  if (points) order.points = *points;
  const bool has_bearing = order.bearing_deg.has_value();
  const bool has_speed = order.speed_m_s.has_value();
  const bool has_points = !order.points.empty();
  const int known = int{has_bearing} + int{has_speed} + int{has_points} + int{!order.reference.empty()};
  const bool is_zero = order.calibration == "zero" && known == 0;
  const bool is_north = order.calibration == "north" && known == 1 && !has_speed && !has_points;
  const bool is_of_speed =
      (order.calibration == "span" || order.calibration == "microphone") && known == 1 && !has_bearing;
  body.require(is_zero || is_north || is_of_speed,
               "calibration: must be zero, north with bearing_deg or reference, or span or microphone with speed_m_s, "
               "points or reference");
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return order;
}

Result<FoundCalibration, Failure> found_calibration_of(std::string_view json) {
  constexpr std::size_t kMaxKeys = 8;
  Body body(json);
  FoundCalibration found;
  found.before = body.values("before", kMaxKeys);
  found.after = body.values("after", kMaxKeys);
  const auto name = [](const auto& one) -> const std::string& { return one.first; };
  body.require(!found.after.empty() && std::ranges::equal(found.before, found.after, {}, name, name),
               "after: must have keys, and before the same ones");
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return found;
}

Result<std::vector<settings::ParameterEdit>, Failure> kept_values_of(std::string_view json) {
  Body body(json);
  std::vector<settings::ParameterEdit> all;
  const auto take = [&all](Body& from, const std::string& name, const std::string& scene) {
    for (auto& [key, value] : from.values(name.c_str(), wire::kMaxParameterEdits))
      all.push_back({scene, std::move(key), std::move(value)});
  };
  take(body, "look", "");
  if (auto scenes = body.below("scenes")) {
    for (const std::string& scene : scenes->keys()) {
      scenes->require(!scene.empty(), "a scene has no name");
      take(*scenes, scene, scene);
    }
    if (auto mistake = scenes->mistake()) return Failure{"scenes: " + mistake->message, FailureKind::kUsage};
  }
  body.require(!all.empty(), "look, scenes: are missing: the values to keep");
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return all;
}

Result<void, Failure> empty_body(std::string_view json) {
  Body body(json);
  if (auto mistake = body.mistake()) return std::move(*mistake);
  return {};
}

Result<wire::PlayerCommand, Failure> player_command_of(std::string_view json) {
  Body body(json);
  wire::PlayerCommand command;
  const std::string action = body.text("action", "");
  command.sensor = body.text("sensor", "");
  command.count = static_cast<std::uint32_t>(body.number("count", 1.0, 1.0, wire::kMaxSteps));
  command.place = body.text("place", "");
  command.rate = body.number("rate", 1.0, wire::kMinPlayRate, wire::kMaxPlayRate);
  const auto* const named = std::ranges::find(kActions, action, &ActionName::name);
  body.require(named != kActions.end(), "action: must be pause, resume, step, seek or rate");
  if (auto mistake = body.mistake()) return std::move(*mistake);
  command.action = named->action;
  return command;
}

}  // namespace yuragi::daemon::web
