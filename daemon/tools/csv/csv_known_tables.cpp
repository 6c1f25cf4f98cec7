#include "daemon/tools/csv/csv_known_tables.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_lines.hpp"
#include "daemon/tools/csv/csv_names.hpp"
#include "daemon/tools/csv/csv_time.hpp"
#include "daemon/tools/csv/csv_value.hpp"
#include "daemon/tools/csv/csv_words.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

std::optional<double> number_in(std::string_view text) {
  const auto number = parse_number(text, Dimension::kNone);
  return number ? std::optional(number->value) : std::nullopt;
}

/// The data follow eight lines, of which the last begins with "DATA PERIODS". The hour of a row ends at its number.
std::optional<KnownTable> find_epw(const std::vector<std::string>& lines) {
  if (lines.empty() || !lines[0].starts_with("LOCATION,")) return std::nullopt;
  const auto last = std::ranges::find_if(lines, [](const auto& line) { return line.starts_with("DATA PERIODS"); });
  if (last == lines.end()) return std::nullopt;
  KnownTable table{.program = "EnergyPlus weather",
                   .header = {"Year", "Month", "Day", "Hour", "Minute flag", "Sources", "Dry bulb (C)", "Dew point (C)",
                              "Relative humidity (%)", "Pressure (Pa)"},
                   .first_row = static_cast<std::size_t>(last - lines.begin()) + 1};
  constexpr std::size_t kDirection = 20;
  while (table.header.size() < kDirection) table.header.push_back(fmt::format("Field {}", table.header.size() + 1));
  table.header.emplace_back("Wind direction (deg)");
  table.header.emplace_back("Wind speed (m/s)");
  return table;
}

/// Rows without a header: date (dd/mm/yy), time, temperature, humidity, dew point, wind, gust, bearing, ...
std::optional<KnownTable> find_cumulus(const std::vector<std::string>& lines) {
  constexpr std::size_t kMinFields = 22;
  constexpr std::size_t kMaxFields = 60;
  constexpr std::size_t kDateLength = 8;
  std::size_t rows = 0;
  for (const std::string& line : lines) {
    if (line.empty()) continue;
    const auto fields = fields_of(line, line.find(';') != std::string::npos ? ';' : ',');
    if (fields.size() < kMinFields || fields.size() > kMaxFields) return std::nullopt;
    if (fields[0].size() != kDateLength || !parse_time(fields[0], TimeFormat::kDayFirst)) return std::nullopt;
    if (fields[1].size() != 5 || fields[1][2] != ':') return std::nullopt;
    const auto is_within = [&](std::size_t i, double least, double greatest) {
      const auto number = number_in(fields[i]);
      return number && *number >= least && *number <= greatest;
    };
    if (!is_within(3, 0.0, 100.0) || !is_within(5, 0.0, 300.0) || !is_within(6, 0.0, 300.0) ||
        !is_within(7, 0.0, 360.0)) {
      return std::nullopt;
    }
    ++rows;
  }
  if (rows == 0) return std::nullopt;
  return KnownTable{.program = "CumulusMX",
                    .header = {"Date (DD/MM/YYYY)", "Time", "Outside temp.", "Outside humidity (%)", "Dew point",
                               "Wind speed", "Wind gust", "Wind direction (deg)"},
                    .first_row = 0,
                    .is_without_units = true};
}

/// The name of a column is in the first of up to three lines, and what it has of that beside the value in the lines
/// below: the direction, marks of quality.
std::optional<KnownTable> find_jma(const std::vector<std::string>& lines) {
  constexpr std::string_view kTime = "年月日";
  const auto names = std::ranges::find_if(lines, [&](const auto& line) { return line.starts_with(kTime); });
  if (names == lines.end()) return std::nullopt;
  KnownTable table{.program = "Japan Meteorological Agency",
                   .header = fields_of(*names, ','),
                   .first_row = static_cast<std::size_t>(names - lines.begin()) + 1};
  for (; table.first_row < lines.size(); ++table.first_row) {
    const auto more = fields_of(lines[table.first_row], ',');
    if (more.size() != table.header.size() || !more[0].empty()) break;
    for (std::size_t i = 1; i < more.size(); ++i) {
      if (!more[i].empty()) table.header[i] = more[i];
    }
  }
  // Each value has its marks, whose names repeat.
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    if (std::ranges::count(table.header, table.header[i]) > 1 && joined(words_of(table.header[i])).empty())
      table.header[i] += fmt::format(" {}", i + 1);
  }
  return table;
}

std::optional<std::string> zone_of_hours(std::string_view text) {
  const auto hours = number_in(text);
  if (!hours || std::abs(*hours) > 14.0) return std::nullopt;
  constexpr double kMinutesPerHour = 60.0;
  const auto minutes = static_cast<int>(std::lround(std::abs(*hours) * kMinutesPerHour));
  return fmt::format("{}{:02}:{:02}", *hours < 0.0 ? '-' : '+', minutes / 60, minutes % 60);
}

/// The number of a channel: "Ch12_Samples_Deg" is of 12.
std::string_view channel_of(std::string_view name) {
  if (!name.starts_with("Ch")) return {};
  const auto end = name.find('_');
  if (end == std::string_view::npos) return {};
  const std::string_view number = name.substr(2, end - 2);
  return number.find_first_not_of("0123456789") == std::string_view::npos ? number : std::string_view();
}

bool is_mean_of(std::string_view name, Dimension dimension) {
  const Name parsed = parse_name(name);
  return parsed.statistic == Statistic::kMean && find_unit(dimension, joined(parsed.unit_words));
}

}  // namespace

std::optional<KnownTable> find_known_table(const std::vector<std::string>& lines) {
  if (auto table = find_epw(lines)) return table;
  if (auto table = find_jma(lines)) return table;
  return find_cumulus(lines);
}

std::optional<std::string> zone_of_first_line(const std::vector<std::string>& lines) {
  if (lines.size() < 2) return std::nullopt;
  const auto fields = fields_of(lines[0], ',');
  constexpr std::size_t kEpwZone = 8;
  if (fields.size() > kEpwZone && fields[0] == "LOCATION") return zone_of_hours(fields[kEpwZone]);
  constexpr std::size_t kTmy3Fields = 7;
  constexpr std::size_t kTmy3Zone = 3;
  if (fields.size() == kTmy3Fields && lines[1].starts_with("Date (MM/DD/YYYY),Time (HH:MM),"))
    return zone_of_hours(fields[kTmy3Zone]);
  return std::nullopt;
}

ColumnNames columns_of_channels(const std::vector<std::string>& lines, const std::vector<std::string>& header) {
  ColumnNames names;
  if (std::ranges::count_if(header, [](const auto& name) { return !channel_of(name).empty(); }) < 2) return names;
  std::string& speed = names[static_cast<std::size_t>(Role::kSpeed)];
  std::string& direction = names[static_cast<std::size_t>(Role::kDirection)];
  const auto first = [&](std::string_view channel, Dimension dimension) {
    const auto found = std::ranges::find_if(header, [&](const std::string& name) {
      const std::string_view own = channel_of(name);
      return !own.empty() && (channel.empty() || own == channel) && is_mean_of(name, dimension);
    });
    return found == header.end() ? std::string() : *found;
  };
  const auto value_of = [](std::string_view line, std::string_view key) {
    return line.starts_with(key) ? without_blanks(line.substr(key.size())) : std::string_view();
  };
  std::string_view vane;
  for (const std::string& line : lines) {
    if (const auto channel = value_of(line, "Channel:"); !channel.empty()) vane = channel;
    const std::string_view anemometer = value_of(line, "Gust Source Channel:");
    if (anemometer.empty() || vane.empty() || !speed.empty()) continue;
    speed = first(anemometer, Dimension::kSpeed);
    direction = first(vane, Dimension::kDirection);
  }
  if (speed.empty()) speed = first({}, Dimension::kSpeed);
  if (direction.empty()) direction = first({}, Dimension::kDirection);
  return names;
}

}  // namespace yuragi::daemon::tools::csv
