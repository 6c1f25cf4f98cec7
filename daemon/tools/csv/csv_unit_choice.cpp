#include "daemon/tools/csv/csv_unit_choice.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_value.hpp"
#include "daemon/tools/csv/csv_words.hpp"
#include "engine/base/compass.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

/// Files whose headers name no units, by columns that only they have. Sources: drivers/SOURCES.md S12.
struct KnownWriter {
  std::string_view name;
  std::array<std::string_view, 2> columns;  ///< all of them are there, as joined(words_of())
  std::string_view speed;
  std::string_view temperature;
};
constexpr std::array kKnownWriters = {
    KnownWriter{"Meteostat", {"wspd", "wpgt"}, "km/h", "C"},
    KnownWriter{"Meteostat", {"wspd", "coco"}, "km/h", "C"},
    KnownWriter{"DWD", {"messdatum", ""}, "m/s", "C"},
    KnownWriter{"KNMI", {"yyyymmdd", "fh"}, "0.1 m/s", "0.1 C"},
    KnownWriter{"MeteoSwiss", {"fkl010z0", ""}, "m/s", "C"},
    KnownWriter{"MeteoSwiss", {"fkl010h0", ""}, "m/s", "C"},
    KnownWriter{"the Iowa Environmental Mesonet", {"sknt", "drct"}, "kn", "F"},
    KnownWriter{"NDBC", {"wspd", "gst"}, "m/s", "C"},
    KnownWriter{"ECMWF", {"u10", "v10"}, "m/s", "K"},
    KnownWriter{"WeatherFlow", {"windlull", "windavg"}, "m/s", "C"},
    KnownWriter{"WSLink", {"t1ws", ""}, "m/s", "C"},
};

bool has_column(const Layout& layout, std::string_view name) {
  return std::ranges::any_of(layout.header, [&](const std::string& each) { return joined(words_of(each)) == name; });
}

void set_where_unknown(Layout& layout, Role role, std::string_view unit, const std::string& source) {
  auto& column = layout.columns.at(role);
  if (!column || column->unit) return;
  column->unit = find_unit(dimension_of(role), unit);
  if (column->unit) column->unit_source = source;
}

/// Takes the units from the system of units that weewx writes: 1 US, 16 metric, 17 metric with m/s (weewx, "Units").
void use_weewx_system(Layout& layout) {
  for (std::size_t i = 0; i < std::min(layout.header.size(), layout.row.size()); ++i) {
    if (joined(words_of(layout.header[i])) != "usunits") continue;
    const auto system = parse_decimal(layout.row[i], 0);
    const bool is_us = system == 1;
    if (!is_us && system != 16 && system != 17) return;
    const std::string source = "by the column \"" + layout.header[i] + "\"";
    const std::string_view speed = is_us ? "mph" : (system == 16 ? "km/h" : "m/s");
    for (const Role role : {Role::kSpeed, Role::kGust}) set_where_unknown(layout, role, speed, source);
    set_where_unknown(layout, Role::kTemperature, is_us ? "F" : "C", source);
    set_where_unknown(layout, Role::kPressure, is_us ? "inHg" : "mbar", source);
    set_where_unknown(layout, Role::kRainRate, is_us ? "in/h" : (system == 16 ? "cm/h" : "mm/h"), source);
  }
}

void use_known_writer(Layout& layout) {
  for (const KnownWriter& writer : kKnownWriters) {
    const bool is_it = std::ranges::all_of(
        writer.columns, [&](std::string_view name) { return name.empty() || has_column(layout, name); });
    if (!is_it) continue;
    const std::string source = "as " + std::string(writer.name) + " writes it";
    for (const Role role : {Role::kSpeed, Role::kGust, Role::kU, Role::kV}) {
      set_where_unknown(layout, role, writer.speed, source);
    }
    set_where_unknown(layout, Role::kTemperature, writer.temperature, source);
    return;
  }
}

/// A column without a unit is in that of one beside it.
void use_unit_beside(Layout& layout, Role role, Role beside) {
  const auto& known = layout.columns.at(beside);
  auto& column = layout.columns.at(role);
  if (!column || column->unit || !known || !known->unit) return;
  column->unit = known->unit;
  column->unit_source = "as \"" + known->name + "\" beside it";
}

/// "5.4 mph": the fields name it themselves.
void use_unit_of_fields(Layout& layout) {
  for (std::size_t index = 0; index < kCsvRoleCount; ++index) {
    auto& column = layout.columns.by_role[index];
    if (!column || column->unit || column->index >= layout.row.size()) continue;
    const auto number = parse_number(layout.row[column->index], dimension_of(static_cast<Role>(index)));
    if (!number || !number->unit) continue;
    column->unit = number->unit;
    column->unit_source = "from its fields";
  }
}

constexpr const char* kSpeedUnits = "m/s, km/h, kn, mph, ft/s or Bft";

Result<void, Failure> check_unknown_units(const Layout& layout) {
  for (std::size_t index = 0; index < kCsvRoleCount; ++index) {
    const auto& column = layout.columns.by_role[index];
    if (!column || column->unit) continue;
    const auto role = static_cast<Role>(index);
    const bool is_speed = dimension_of(role) == Dimension::kSpeed;
    if (!is_speed && role != Role::kDirection) continue;
    const std::string option = role == Role::kGust        ? "--gust-unit or --unit"
                               : role == Role::kDirection ? "--direction-unit"
                                                          : "--unit";
    const std::string allowed = is_speed ? std::string(kSpeedUnits) : "deg, rad or point16";
    if (!column->unknown_unit.empty()) {
      return Failure{fmt::format("the unit \"{}\" of column \"{}\" is not known; add {} with {}", column->unknown_unit,
                                 column->name, option, allowed)};
    }
    if (is_speed && !layout.without_units.empty()) {
      return Failure{
          fmt::format("{} writes no units into its files; add --unit with {}", layout.without_units, allowed)};
    }
  }
  return {};
}

/// The numbers of directions: as the user states it, or else as the column is named.
void set_direction_unit(Layout& layout, DirectionUnit unit) {
  auto& column = layout.columns.at(Role::kDirection);
  if (!column || unit == DirectionUnit::kAuto) return;
  column->unit = unit == DirectionUnit::kPoint16
                     ? Unit{"points of 22.5 degrees", kDegPerCompassPoint}
                     : find_unit(Dimension::kDirection, unit == DirectionUnit::kRadians ? "rad" : "deg");
  column->unit_source = "by --direction-unit";
}

void set_by_option(Layout& layout, Role role, const std::optional<Unit>& unit, const char* option) {
  auto& column = layout.columns.at(role);
  if (!column || !unit) return;
  column->unit = unit;
  column->unit_source = std::string("by ") + option;
}

}  // namespace

Result<void, Failure> choose_units(Layout& layout, const ImportOptions& options) {
  for (const Role role : {Role::kSpeed, Role::kGust, Role::kU, Role::kV, Role::kVerticalSpeed}) {
    set_by_option(layout, role, options.unit, "--unit");
  }
  set_by_option(layout, Role::kGust, options.gust_unit, "--gust-unit");
  set_direction_unit(layout, options.direction_unit);
  use_unit_of_fields(layout);
  if (auto known = check_unknown_units(layout); !known) return known;
  use_weewx_system(layout);
  use_known_writer(layout);
  use_unit_beside(layout, Role::kGust, Role::kSpeed);
  use_unit_beside(layout, Role::kSpeed, Role::kGust);
  use_unit_beside(layout, Role::kU, Role::kV);
  use_unit_beside(layout, Role::kV, Role::kU);
  use_unit_beside(layout, Role::kVerticalSpeed, Role::kU);
  for (std::size_t index = 0; index < kCsvRoleCount; ++index) {
    auto& column = layout.columns.by_role[index];
    const auto role = static_cast<Role>(index);
    if (!column || column->unit || dimension_of(role) == Dimension::kNone || role == Role::kTime ||
        role == Role::kElapsed) {
      continue;
    }
    column->unit = base_unit(dimension_of(role));
    column->unit_source = kAssumedUnit;
  }
  return {};
}

}  // namespace yuragi::daemon::tools::csv
