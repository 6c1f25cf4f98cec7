#include "daemon/tools/csv/csv_columns.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "engine/base/units.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

constexpr drivers::sensor::SpeedUnit kMetresPerSecond{"m/s", 1.0};
constexpr drivers::sensor::SpeedUnit kKilometresPerHour{"km/h", kMetresPerSecondPerKmh};
constexpr drivers::sensor::SpeedUnit kKnots{"kn", kMetresPerSecondPerKnot};
constexpr drivers::sensor::SpeedUnit kMilesPerHour{"mph", kMetresPerSecondPerMph};

constexpr std::array<std::pair<std::string_view, drivers::sensor::SpeedUnit>, 14> kSpeedUnits = {
    {{"ms", kMetresPerSecond},
     {"ms1", kMetresPerSecond},
     {"mps", kMetresPerSecond},
     {"mpers", kMetresPerSecond},
     {"kmh", kKilometresPerHour},
     {"kmh1", kKilometresPerHour},
     {"kph", kKilometresPerHour},
     {"kmph", kKilometresPerHour},
     {"kn", kKnots},
     {"kt", kKnots},
     {"kts", kKnots},
     {"knot", kKnots},
     {"knots", kKnots},
     {"mph", kMilesPerHour}}};

// Usual names of columns, in lower case, without punctuation and unit. The first that is found is used.
constexpr std::array<std::string_view, 15> kTimeNames = {"utc",       "utctime",  "timeutc", "datetimeutc", "dateutc",
                                                         "timestamp", "datetime", "isotime", "time",        "date",
                                                         "unixtime",  "unix",     "epoch",   "ts",          "t"};
constexpr std::array<std::string_view, 14> kSpeedNames = {
    "speed",        "windspeed",    "windspd", "wspeed",        "wspd",          "ws",  "wv", "ff",
    "windspeedavg", "avgwindspeed", "windavg", "windspeedmean", "meanwindspeed", "wind"};
constexpr std::array<std::string_view, 10> kDirectionNames = {
    "direction", "winddirection", "winddir", "wdir", "wd", "dd", "dir", "winddirectionavg", "bearing", "windbearing"};
constexpr std::array<std::string_view, 9> kGustNames = {
    "gust", "windgust", "windgusts", "gustspeed", "gusts", "windgustspeed", "wgust", "maxwindspeed", "windspeedmax"};
constexpr std::array<std::string_view, 6> kUNames = {"u", "uwind", "windu", "ucomponent", "ugrd", "eastward"};
constexpr std::array<std::string_view, 6> kVNames = {"v", "vwind", "windv", "vcomponent", "vgrd", "northward"};

std::span<const std::string_view> usual_names(CsvRole role) {
  switch (role) {
    case CsvRole::kTime:
      return kTimeNames;
    case CsvRole::kSpeed:
      return kSpeedNames;
    case CsvRole::kDirection:
      return kDirectionNames;
    case CsvRole::kGust:
      return kGustNames;
    case CsvRole::kU:
      return kUNames;
    case CsvRole::kV:
      return kVNames;
    case CsvRole::kElapsed:
    case CsvRole::kQuality:
    case CsvRole::kSensor:
      break;  // only in yuragi's own exports
  }
  return {};
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_word_sign(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
}

/// The words of a name in lower case: "Wind Speed (km/h)" has wind, speed, km, h.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  for (const char sign : name) {
    const char c = lower(sign);
    if (is_word_sign(c)) {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::string joined(std::span<const std::string> words) {
  std::string all;
  for (const std::string& word : words) all += word;
  return all;
}

/// A parsed name: "wind_speed_10m (km/h)" is "windspeed" in "kmh".
struct NameParts {
  std::string stem;
  std::string unit;
};

NameParts parts_of(std::string_view name) {
  std::vector<std::string> words = words_of(name);
  const auto is_unit = [](std::string_view text) {
    static constexpr std::array<std::string_view, 9> kOthers = {"deg", "degree",  "degrees", "rad",    "radian",
                                                                "s",   "radians", "sec",     "seconds"};
    return find_speed_unit(text).has_value() || std::find(kOthers.begin(), kOthers.end(), text) != kOthers.end();
  };

  // The longest unit at the end: m_s_1 before s_1.
  NameParts parts;
  for (std::size_t count = std::min<std::size_t>(3, words.empty() ? 0 : words.size() - 1); count > 0; --count) {
    const std::string unit = joined(std::span(words).last(count));
    if (!is_unit(unit)) continue;
    parts.unit = unit;
    words.resize(words.size() - count);
    break;
  }

  // A height is not part of the name.
  std::erase_if(words, [](const std::string& word) {
    return word.size() > 1 && word.back() == 'm' &&
           std::all_of(word.begin(), word.end() - 1, [](char c) { return c >= '0' && c <= '9'; });
  });
  parts.stem = joined(words);
  return parts;
}

CsvColumn column_at(const std::vector<std::string>& header, std::size_t index) {
  const std::string& name = header[index];
  const NameParts parts = parts_of(name);
  return {.name = name,
          .index = index,
          .unit = find_speed_unit(parts.unit),
          .is_in_radians = parts.unit.starts_with("rad"),
          .is_in_ms = parts.unit == "ms"};
}

bool equal_in_any_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

std::string_view name_of(CsvRole role) {
  static constexpr std::array<std::string_view, kCsvRoleCount> kNames = {
      "time", "elapsed", "speed", "direction", "gust", "u", "v", "quality", "sensor"};
  return kNames.at(static_cast<std::size_t>(role));
}

std::optional<drivers::sensor::SpeedUnit> find_speed_unit(std::string_view name) {
  const std::string plain = joined(words_of(name));
  for (const auto& [known, unit] : kSpeedUnits) {
    if (known == plain) return unit;
  }
  return std::nullopt;
}

Result<CsvColumns, Failure> choose_columns(const std::vector<std::string>& header, const CsvColumnNames& given) {
  CsvColumns columns;
  const auto at = [&columns](CsvRole role) -> std::optional<CsvColumn>& {
    return columns[static_cast<std::size_t>(role)];
  };
  const auto is_given = [&given](CsvRole role) { return !given[static_cast<std::size_t>(role)].empty(); };

  // As the user says.
  for (std::size_t role = 0; role < kCsvRoleCount; ++role) {
    if (given[role].empty()) continue;
    const auto found = std::find_if(header.begin(), header.end(),
                                    [&](const std::string& name) { return equal_in_any_case(name, given[role]); });
    if (found == header.end()) {
      return Failure{"there is no column \"" + given[role] + "\"; the columns are " + listed(header)};
    }
    columns[role] = column_at(header, static_cast<std::size_t>(found - header.begin()));
  }

  // By their names. Components are searched for only where there is no speed, and vice versa.
  const auto guess = [&](CsvRole role) {
    if (at(role)) return;
    for (const std::string_view usual : usual_names(role)) {
      for (std::size_t i = 0; i < header.size(); ++i) {
        if (!at(role) && parts_of(header[i]).stem == usual) at(role) = column_at(header, i);
      }
    }
  };
  guess(CsvRole::kTime);
  guess(CsvRole::kGust);
  const bool wants_components = is_given(CsvRole::kU) || is_given(CsvRole::kV);
  if (!wants_components) guess(CsvRole::kSpeed);
  if (at(CsvRole::kSpeed)) {
    guess(CsvRole::kDirection);
  } else {
    guess(CsvRole::kU);
    guess(CsvRole::kV);
  }

  // yuragi's own exports have further columns.
  if (fmt::format("{}", fmt::join(header, ",")) == kExportedHeader) {
    const auto named = [&header](std::string_view name) {
      return column_at(header, static_cast<std::size_t>(std::ranges::find(header, name) - header.begin()));
    };
    if (!is_given(CsvRole::kTime)) at(CsvRole::kElapsed) = named("time_s");
    at(CsvRole::kSensor) = named("sensor");
    at(CsvRole::kQuality) = named("quality");
  }

  if (!at(CsvRole::kTime)) {
    return Failure{"no column looks like a time; the columns are " + listed(header) + "; name it with --time COLUMN"};
  }
  if (!at(CsvRole::kSpeed) && (!at(CsvRole::kU) || !at(CsvRole::kV))) {
    return Failure{"no column looks like a wind speed, nor two like u and v; the columns are " + listed(header) +
                   "; name it with --speed COLUMN, or --u COLUMN --v COLUMN"};
  }
  for (const auto& column : columns) {
    if (column && std::ranges::count(header, column->name) > 1) {
      return Failure{"the column \"" + column->name + "\" is duplicated in the header"};
    }
  }
  return columns;
}

}  // namespace yuragi::daemon::tools::csv
