#pragma once

#include <string>
#include <vector>

#include "daemon/values/moment.hpp"
#include "engine/base/fields.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings::feeds {

/// Where something listens, for programs that search the network.
struct NetworkService {
  std::string type = {};     ///< RFC 6763: "_osc._udp"
  std::string address = {};  ///< ADDRESS:PORT; :PORT: all addresses
  friend bool operator==(const NetworkService&, const NetworkService&) = default;
};

/// [osc_query]: where programs read which OSC addresses there are, and listen to them.
struct OscQuery {
  std::string listen = {};  ///< ADDRESS:PORT; empty: nowhere
  bool announces = false;
  std::string name = {};  ///< for other programs
  values::Wind wind = values::Wind::kShaped;
  std::vector<NetworkService> sensors = {};  ///< that others send to
  friend bool operator==(const OscQuery&, const OscQuery&) = default;
};

const Fields<OscQuery>& osc_query_fields();

/// Fills it from the values of osc_query_fields().
std::vector<ParameterError> fill_osc_query(OscQuery& osc_query, const ParameterValues& values);

}  // namespace yuragi::daemon::settings::feeds
