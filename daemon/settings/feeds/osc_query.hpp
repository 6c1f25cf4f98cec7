#pragma once

#include <string>
#include <vector>

#include "daemon/values/moment.hpp"
#include "engine/base/fields.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings::feeds {

/// [osc_query]: where programs read which OSC addresses there are, and listen to them.
struct OscQuery {
  std::string listen = {};  ///< ADDRESS:PORT; empty: nowhere
  bool announces = false;
  std::string name = {};  ///< for other programs
  values::Wind wind = values::Wind::kShaped;
  friend bool operator==(const OscQuery&, const OscQuery&) = default;
};

const Fields<OscQuery>& osc_query_fields();

/// Fills it from the values of osc_query_fields().
std::vector<ParameterError> fill_osc_query(OscQuery& osc_query, const ParameterValues& values);

}  // namespace yuragi::daemon::settings::feeds
