#include "daemon/settings/sensor_blend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings {
namespace {

constexpr std::string_view kAuto = "auto";
constexpr std::string_view kAtTheEdge =
    "its gusts enter at the windward edge of the scenes, wherever the wind comes from, and cross all of them";
constexpr std::array<std::string_view, 4> kValues = {kAuto, wind::kReadingValueNames[0], wind::kReadingValueNames[1],
                                                     wind::kReadingValueNames[2]};
constexpr std::array<std::string_view, 3> kRoles = {kAuto, "absolute", "relative"};

enum class Role : std::uint8_t { kOfDriver, kAbsolute, kRelative };

/// [sensor.blend] as it is written.
struct BlendTable {
  wind::blend::SourceSettings settings;
  Role role = Role::kOfDriver;
  std::optional<double> east_m;
  std::optional<double> south_m;
  std::string value;
  double averaging_s = 0.0;
};

auto of_blend(auto member) {
  return member_of(&BlendTable::settings, member);
}

const Fields<BlendTable>& blend_fields() {
  static const Fields<BlendTable> kFields{
      {{.name = "role",
        .default_value = std::string(kAuto),
        .help = "relative: only its fluctuations are used, for the gusts that the absolute sensors are too slow "
                "for, scaled to theirs. auto: relative for a microphone, absolute for all others",
        .choices = kRoles},
       &BlendTable::role},
      {{.name = "priority",
        .default_value = std::int64_t{0},
        .min = 0,
        .max = 1000,
        .help = "of the live sensors those with the lowest number make the wind, equal ones together; 0: its "
                "position in the file, from 1"},
       of_blend(&wind::blend::SourceSettings::priority)},
      {{.name = "weight",
        .default_value = 1.0,
        .min = 0.01,
        .max = 100.0,
        .help = "weight among sensors of the same priority"},
       of_blend(&wind::blend::SourceSettings::weight)},
      {{.name = "x",
        .unit = "m",
        .default_value = 0.0,
        .min = -1000.0,
        .max = 1000.0,
        .help = "position to the east of the middle of the scenes; measured gusts travel from there with the "
                "wind; scenes upwind of it have generated gusts",
        .left_out = kAtTheEdge},
       &BlendTable::east_m},
      {{.name = "z",
        .unit = "m",
        .default_value = 0.0,
        .min = -1000.0,
        .max = 1000.0,
        .help = "position to the south of the middle of the scenes; if only one of x and z is set, the other is 0",
        .left_out = kAtTheEdge},
       &BlendTable::south_m},
      {{.name = "lead",
        .unit = "m",
        .default_value = 0.0,
        .min = 0.0,
        .max = 1000.0,
        .help = "with x or z: its gusts enter the scenes this far upwind of its position. More of the scenes has "
                "measured gusts, but later, by lead over wind speed"},
       of_blend(&wind::blend::SourceSettings::lead_m)},
      {{.name = "value",
        .default_value = std::string(kAuto),
        .help =
            "what the station reports: mean, the mean wind over the averaging time; instant, the instantaneous wind: "
            "short gusts that it happens to sample then do not count as slow ones; maximum, the strongest wind "
            "of a period, which is shown but not used as wind. auto: what the driver or profile states; if "
            "that is nothing, what half an hour of readings shows, if they are close enough; until then instant for "
            "readings at most 30 s apart, otherwise mean. `yuragi sensors watch` shows it",
        .choices = kValues},
       &BlendTable::value},
      {{.name = "averaging",
        .unit = "s",
        .default_value = 0.0,
        .min = 0.0,
        .max = 3600.0,
        .help = "averaging time of each reading; above 0 the reading is a mean, unless value is set; 0: the time that "
                "the driver or profile states, or the interval between readings, which is measured"},
       &BlendTable::averaging_s},
      {{.name = "direction_step",
        .unit = "deg",
        .default_value = 0.0,
        .min = 0.0,
        .max = 90.0,
        .help = "step of a vane with few directions (16: 22.5, 8: 45); 0: determined from its readings"},
       of_blend(&wind::blend::SourceSettings::direction_step_deg)},
  };
  return kFields;
}

}  // namespace

std::span<const Parameter> sensor_blend_parameters() {
  return blend_fields().parameters();
}

drivers::sensor::StatedValue sensor_value_of(const ParameterValues& values,
                                             const std::optional<drivers::sensor::StatedValue>& stated) {
  constexpr const char* kHere = "[sensor.blend]";
  const BlendTable table = blend_fields().of(values);
  const auto name = std::ranges::find(wind::kReadingValueNames, table.value);
  const bool is_set = name != wind::kReadingValueNames.end();
  const double averaging_s = table.averaging_s;
  drivers::sensor::StatedValue value = stated.value_or(drivers::sensor::StatedValue{});
  if (is_set) {
    value.value = static_cast<wind::ReadingValue>(name - wind::kReadingValueNames.begin());
    // The time that the driver states belongs to the value that it states.
    if (!stated || stated->value != value.value) value.averaging_s = 0.0;
  } else if (averaging_s > 0.0 && makes_wind(value.value)) {
    value.value = wind::ReadingValue::kMean;
  }
  if (averaging_s > 0.0) value.averaging_s = averaging_s;
  if (value.value == wind::ReadingValue::kInstant) value.averaging_s = 0.0;
  if (is_set || averaging_s > 0.0) value.source = kHere;
  return value;
}

std::string place_text(const wind::blend::SourceSettings& source) {
  if (!source.has_place) return "at the windward edge of the scenes";
  const auto way = [](double way_m, const char* to, const char* back) {
    return way_m == 0.0 ? std::string() : fmt::format("{:g} m {}", std::abs(way_m), way_m > 0.0 ? to : back);
  };
  const std::string east = way(source.east_m, "east", "west");
  const std::string south = way(source.south_m, "south", "north");
  std::string text = east + (east.empty() || south.empty() ? "" : " and ") + south;
  text = text.empty() ? "in the middle of the scenes" : text + " of the middle of the scenes";
  if (source.lead_m > 0.0) text += fmt::format(", taken {:g} m upwind of there", source.lead_m);
  return text;
}

Result<wind::blend::SourceSettings, ParameterError> blend_source_of(const ParameterValues& values,
                                                                    const drivers::sensor::DriverDescription& driver) {
  const BlendTable table = blend_fields().of(values);
  wind::blend::SourceSettings settings = table.settings;
  settings.has_place = table.east_m || table.south_m;
  settings.east_m = table.east_m.value_or(0.0);
  settings.south_m = table.south_m.value_or(0.0);
  settings.is_relative = table.role == Role::kRelative || (table.role == Role::kOfDriver && driver.is_relative);
  settings.fits_site = !settings.is_relative && !driver.plays_recordings;
  if (settings.lead_m > 0.0 && !settings.has_place) {
    return ParameterError{"lead", "needs the position of the sensor; give x or z, too, or remove it"};
  }
  return settings;
}

}  // namespace yuragi::daemon::settings
