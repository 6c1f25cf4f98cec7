#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/page_file.hpp"
#include "daemon/web/calibration_order.hpp"
#include "engine/base/result.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::web {

// The bodies of requests, which are JSON, as requests of the stream. Hostile until here: a key that is not known, a
// value of another type or beyond its limit is refused with its name. Pure.

/// {"scene": name, "shown": true, "hide_others": false, "over_s": 2}
Result<wire::Control, Failure> scene_control_of(std::string_view json);

/// A code that somebody has typed to be let in.
struct Pairing {
  std::string code;
};

/// {"code": "K7QM-2XPD"}
Result<Pairing, Failure> pairing_of(std::string_view json);

/// The id of a session that is to be ended.
struct Revocation {
  std::string id;
};

/// {"revoke": "3f9a0c77e1"}
Result<Revocation, Failure> revocation_of(std::string_view json);

/// What the client of a WebSocket wants to be sent.
struct SocketWish {
  static constexpr double kMaxWindRate_hz = 240.0;
  static constexpr double kMaxStatusRate_hz = 2.0;
  static constexpr std::size_t kMaxPlaces = 64;

  double wind_hz = 0.0;    ///< the values of the wind; 0: none
  double status_hz = 0.0;  ///< the daemon's state; 0: none
  std::vector<std::string> places = {};
  std::optional<wire::Subscribe> stream = std::nullopt;  ///< the stream's own messages; nullopt: none
};

/// {"wind": 60, "status": 2, "places": [names], "stream": {"scenes": [names], "every": 8, "rate": 30}}; each key can be
/// left out.
Result<SocketWish, Failure> socket_wish_of(std::string_view json);

/// {"scene": name, or left out for [look], "set": {key: value}, "reset": [keys]}; a value is a text, a number, true or
/// false
Result<wire::ParameterCommand, Failure> parameter_command_of(std::string_view json);

/// {"speed_m_s": 8, "direction_deg": 270, "for_s": 60} or {"release": true}
Result<wire::HandCommand, Failure> wind_by_hand_of(std::string_view json);

/// {"for_s": 3600}, with null until somebody ends it, or {"release": true}
Result<wire::HandCommand, Failure> blackout_of(std::string_view json);

/// {"camera": name, "for_s": 3600}, with null until somebody ends it, or {"release": true}
Result<wire::HandCommand, Failure> camera_of(std::string_view json);

/// {}
Result<wire::ReloadCommand, Failure> reload_command_of(std::string_view json);

/// {"driver": name, "parameters": {key: value}}, and if it is to be added "name"
Result<settings::PageSensor, Failure> sensor_of(std::string_view json, bool has_name);

/// {"calibration": "zero", "for_s": 30}; "north" with "bearing_deg" or "reference"; "span" or "microphone" with
/// "speed_m_s", "reference", or "points", which are "MEASURED:TRUE MEASURED:TRUE" in m/s, rising
Result<CalibrationOrder, Failure> calibration_order_of(std::string_view json);

/// {"before": {key: value}, "after": {key: value}} with the same keys in both
Result<FoundCalibration, Failure> found_calibration_of(std::string_view json);

/// {"look": {key: value}, "scenes": {name: {key: value}}}; each can be left out, but not both
Result<std::vector<settings::ParameterEdit>, Failure> kept_values_of(std::string_view json);

/// {}, of a request whose path has all
Result<void, Failure> empty_body(std::string_view json);

/// {"action": "pause", "resume", "step", "seek" or "rate", "sensor": name, "count": 1, "place": "+30", "rate": 1}
Result<wire::PlayerCommand, Failure> player_command_of(std::string_view json);

}  // namespace yuragi::daemon::web
