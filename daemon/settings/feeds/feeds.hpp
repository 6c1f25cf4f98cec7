#pragma once

#include <string>
#include <vector>

#include "daemon/settings/feeds/dmx.hpp"
#include "daemon/settings/feeds/mqtt.hpp"
#include "daemon/settings/feeds/nmea.hpp"
#include "daemon/settings/feeds/osc.hpp"
#include "daemon/settings/feeds/osc_query.hpp"
#include "daemon/values/grid.hpp"
#include "daemon/values/moment.hpp"
#include "daemon/values/moment_maker.hpp"

namespace yuragi::daemon::settings::feeds {

/// What is sent to other programs: the typed form of the lists of list_tables(), and of [mqtt] and [osc_query].
struct Config {
  std::vector<values::Place> places = {};
  std::vector<Osc> osc = {};
  std::vector<Dmx> dmx = {};
  Mqtt mqtt = {};
  OscQuery osc_query = {};
  std::vector<Nmea> nmea = {};

  friend bool operator==(const Config&, const Config&) = default;

  /// Is the real wind of the places wanted by any feed?
  bool wants_real_places() const;

  /// The grids of all feeds, no two alike.
  std::vector<values::Grid> grids() const;
};

}  // namespace yuragi::daemon::settings::feeds
