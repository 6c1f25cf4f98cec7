#include "daemon/settings/feeds/place.hpp"

#include <utility>

#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings::feeds {
namespace {

constexpr double kFarthest_m = 1000.0;

const Fields<values::Place>& place_fields() {
  static const Fields<values::Place> kFields{
      {{.name = "x",
        .unit = "m",
        .default_value = 0.0,
        .min = -kFarthest_m,
        .max = kFarthest_m,
        .help = "east of the middle of the scenes"},
       &values::Place::east_m},
      {{.name = "z", .unit = "m", .default_value = 0.0, .min = -kFarthest_m, .max = kFarthest_m, .help = "south of it"},
       &values::Place::south_m},
  };
  return kFields;
}

}  // namespace

std::span<const Parameter> place_parameters() {
  return place_fields().parameters();
}

values::Place place_of(std::string name, const ParameterValues& values) {
  values::Place place = place_fields().of(values);
  place.name = std::move(name);
  return place;
}

}  // namespace yuragi::daemon::settings::feeds
