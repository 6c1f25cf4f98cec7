#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/values/moment.hpp"
#include "engine/base/fields.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/secret.hpp"

namespace yuragi::daemon::settings::feeds {

/// [mqtt]: the broker to which the wind is published.
struct Mqtt {
  std::string host = {};  ///< empty: nothing is published
  std::uint16_t port = 0;
  std::string user = {};  ///< empty: none
  Secret password;
  std::string password_file = {};  ///< empty: none
  bool uses_tls = false;
  std::string ca_file = {};  ///< empty: the certificates of the system
  std::string topic = {};    ///< of all messages, without a slash at the end
  double every_s = 0.0;
  double fast_hz = 0.0;             ///< 0: off
  std::string home_assistant = {};  ///< prefix of Home Assistant's discovery; empty: off
  bool takes_commands = false;
  values::Wind wind = values::Wind::kShaped;
  friend bool operator==(const Mqtt&, const Mqtt&) = default;

  std::uint16_t used_port() const { return port != 0 ? port : (uses_tls ? 8883 : 1883); }
};

const Fields<Mqtt>& mqtt_fields();

/// Fills it from the values of mqtt_fields(). Returns the contradictions.
std::vector<ParameterError> fill_mqtt(Mqtt& mqtt, const ParameterValues& values);

}  // namespace yuragi::daemon::settings::feeds
