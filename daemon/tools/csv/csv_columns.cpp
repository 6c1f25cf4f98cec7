#include "daemon/tools/csv/csv_columns.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_names.hpp"
#include "daemon/tools/csv/csv_time.hpp"
#include "daemon/tools/csv/csv_usual_names.hpp"
#include "daemon/tools/csv/csv_words.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

constexpr std::string_view kByName = "by its name";
constexpr std::string_view kUtc = "utc";

bool is_any_of(std::string_view text, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, text) != names.end();
}

std::string listed(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The name of a time's column without its zone: "Date Time, GMT-07:00" is "datetime".
std::string time_stem(std::string_view name) {
  std::vector<std::string> words = words_of(name);
  std::erase_if(words, [](const std::string& word) {
    return is_any_of(word, {"utc", "gmt", "z", "lt", "hst"}) ||
           word.find_first_not_of("0123456789") == std::string::npos;
  });
  while (words.size() > 1 && is_any_of(words.back(), {"ms", "s", "sec", "seconds", "iso"})) words.pop_back();
  std::string stem = words.empty() ? "time" : joined(words);
  if (stem.size() > kUtc.size() && stem.ends_with(kUtc)) stem.resize(stem.size() - kUtc.size());
  return stem;
}

/// Returns the zone in the name of a time's column: "GMT-07:00", "UTC"; or that of American standard times.
std::optional<std::string> zone_in_name(std::string_view name) {
  const std::string text = lower(name);
  for (const std::string_view word : {"utc", "gmt"}) {
    const auto at = text.find(word);
    if (at == std::string::npos) continue;
    const auto end = text.find_first_not_of("+-0123456789: ", at + word.size());
    const std::string_view offset =
        without_blanks(std::string_view(text).substr(at + word.size(), end - at - word.size()));
    return offset.starts_with('+') || offset.starts_with('-') ? std::string(offset) : std::string("UTC");
  }
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kStandardTimes = {
      {{"est", "-05:00"}, {"cst", "-06:00"}, {"mst", "-07:00"}, {"pst", "-08:00"}}};
  for (const std::string& word : words_of(name)) {
    for (const auto& [known, offset] : kStandardTimes) {
      if (word == known) return std::string(offset);
    }
  }
  return std::nullopt;
}

/// One choice of columns.
class ColumnChoice {
 public:
  ColumnChoice(const std::vector<std::string>& header, const ColumnNames& given, const std::vector<std::string>& row)
      : header_(header), given_(given), row_(row), is_taken_(header.size(), false) {
    for (const std::string& name : header) {
      names_.push_back(parse_name(name));
      time_stems_.push_back(time_stem(name));
    }
  }

  Result<Columns, Failure> choose() {
    if (const auto done = take_given(); !done) return done.error();
    choose_time();
    if (columns_.time_parts.empty()) return checked();
    choose_wind();
    for (const Role role : kQuantityRoles) guess(role);
    take_exported();
    return checked();
  }

  Result<Columns, Failure> choose_of_keys() {
    for (std::size_t role = 0; role < kCsvRoleCount; ++role) {
      if (const auto key = find(given_[role])) take(static_cast<Role>(role), *key);
    }
    if (is_given(Role::kSpeed) && !columns_.at(Role::kSpeed)) return Failure{"no key " + given_of(Role::kSpeed)};
    choose_time();
    choose_wind();
    for (const Role role : kQuantityRoles) guess(role);
    const auto& speed = columns_.at(Role::kSpeed);
    if (speed && !is_given(Role::kSpeed) && names_[speed->index].stem.size() < 2)
      return Failure{"the speed has a name of one letter"};
    return checked_wind();
  }

 private:
  const std::string& given_of(Role role) const { return given_[static_cast<std::size_t>(role)]; }
  bool is_given(Role role) const { return !given_[static_cast<std::size_t>(role)].empty(); }

  Result<void, Failure> take_given() {
    for (std::size_t role = 0; role < kCsvRoleCount; ++role) {
      if (given_[role].empty()) continue;
      const auto found = find(given_[role]);
      if (!found) return Failure{"there is no column \"" + given_[role] + "\"; the columns are " + listed(header_)};
      take(static_cast<Role>(role), *found);
    }
    return {};
  }

  /// The column of a name in capitals or not; nullopt for no name.
  std::optional<std::size_t> find(const std::string& given) const {
    if (given.empty()) return std::nullopt;
    const auto found = std::ranges::find_if(header_, [&](const auto& name) { return lower(name) == lower(given); });
    if (found == header_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - header_.begin());
  }

  void take(Role role, std::size_t index) {
    const Name& name = names_[index];
    Column column{.name = header_[index],
                  .index = index,
                  .unit = find_unit(dimension_of(role), joined(name.unit_words)),
                  .unit_source = {},
                  .unknown_unit = name.unknown_unit};
    if (column.unit) column.unit_source = kByName;
    columns_.at(role) = column;
    is_taken_[index] = true;
  }

  /// Takes the first column with one of a role's usual names. Of two directions it is the one in degrees.
  void guess(Role role) {
    if (columns_.at(role)) return;
    if (role == Role::kDirection && take_usual(role, true)) return;
    if (take_usual(role, false)) return;
    if (role == Role::kGust) guess_greatest_speed();
  }

  /// "windspeedmph" is "windspeed" in mph.
  bool take_usual(Role role, bool is_unit_needed) {
    for (const std::string_view usual : usual_names(role)) {
      for (std::size_t i = 0; i < header_.size(); ++i) {
        if (is_taken_[i]) continue;
        const Name& name = names_[i];
        const Statistic wanted = role == Role::kGust ? Statistic::kMax : Statistic::kMean;
        if (name.statistic != Statistic::kMean && name.statistic != wanted) continue;
        // "Wind (deg)" is no speed.
        const bool is_of_another_dimension =
            !name.unit_words.empty() && !find_unit(dimension_of(role), joined(name.unit_words));
        // Of a speed or a direction an unknown unit is asked for; "Temperature (indoor)" is another temperature.
        const bool is_wind = dimension_of(role) == Dimension::kSpeed || dimension_of(role) == Dimension::kDirection;
        if (is_of_another_dimension || (!is_wind && !name.unknown_unit.empty())) continue;
        if (name.stem == usual && (!is_unit_needed || !name.unit_words.empty())) {
          take(role, i);
          return true;
        }
        if (name.stem == usual || !name.stem.starts_with(usual)) continue;
        const auto unit = find_unit(dimension_of(role), std::string_view(name.stem).substr(usual.size()));
        if (!unit) continue;
        take(role, i);
        columns_.at(role)->unit = unit;
        columns_.at(role)->unit_source = kByName;
        return true;
      }
    }
    return false;
  }

  /// A column of greatest speeds is one of gusts: WS_ms_Max.
  void guess_greatest_speed() {
    for (const std::string_view usual : usual_names(Role::kSpeed)) {
      for (std::size_t i = 0; i < header_.size(); ++i) {
        const Name& name = names_[i];
        if (!is_taken_[i] && name.statistic == Statistic::kMax && name.stem == usual) return take(Role::kGust, i);
      }
    }
  }

  /// Prefers a column that is marked as UTC to one that may be in local time.
  std::optional<std::size_t> find_time_column(Role role) const {
    for (const bool is_utc_wanted : {true, false}) {
      for (const std::string_view usual : usual_names(role)) {
        for (std::size_t i = 0; i < header_.size(); ++i) {
          const bool is_usual = !is_taken_[i] && !header_[i].empty() && time_stems_[i] == usual;
          if (is_usual && (!is_utc_wanted || zone_in_name(header_[i]) == "UTC")) return i;
        }
      }
    }
    return std::nullopt;
  }

  std::string_view first_value(std::size_t index) const {
    return index < row_.size() ? std::string_view(row_[index]) : std::string_view();
  }

  void choose_time() {
    if (!columns_.at(Role::kTime) && !columns_.at(Role::kDate)) {
      if (choose_calendar_columns()) return;
      choose_time_by_name();
    }
    if (!columns_.at(Role::kTime) && columns_.at(Role::kDate)) columns_.at(Role::kTime).swap(columns_.at(Role::kDate));
    if (!columns_.at(Role::kTime)) return;
    if (columns_.at(Role::kDate)) columns_.time_parts.push_back({columns_.at(Role::kDate)->index});
    columns_.time_parts.push_back({columns_.at(Role::kTime)->index});
    for (const TimePart& part : columns_.time_parts) read_time_name(header_[part.column]);
  }

  void choose_time_by_name() {
    const auto moment = find_time_column(Role::kTime);
    // Date and time in one column are better than in two.
    if (moment && has_date(first_value(*moment)) && first_value(*moment).find(':') != std::string_view::npos)
      return take(Role::kTime, *moment);
    const auto date = find_time_column(Role::kDate);
    const auto clock = date ? find_clock_beside(*date) : std::nullopt;
    if (!moment && date && clock) {
      take(Role::kDate, *date);
      take(Role::kTime, *clock);
      return;
    }
    if (!moment) {
      // The index of a table is written without a name.
      const bool is_index = !header_.empty() && is_any_of(lower(header_[0]), {"", "index", "unnamed: 0"});
      if (is_index && has_date(first_value(0))) take(Role::kTime, 0);
      return;
    }
    const bool is_split =
        date && clock && !has_date(first_value(*clock)) && first_value(*date).find(':') == std::string_view::npos;
    if (is_split) {
      take(Role::kDate, *date);
      take(Role::kTime, *clock);
      return;
    }
    take(Role::kTime,
         date && *moment != *date && !row_.empty() && !has_date(first_value(*moment)) && has_date(first_value(*date))
             ? *date
             : *moment);
  }

  /// The column of the time of day, where that of the date is another.
  std::optional<std::size_t> find_clock_beside(std::size_t date) const {
    for (const std::string_view usual : {"time", "uhrzeit", "zeit", "heure", "hour", "hh", "clock", "localtime", "mst",
                                         "est", "cst", "pst", "lst", "timehhmm", "hhmm", "hrmn", "timelst"}) {
      for (std::size_t i = 0; i < header_.size(); ++i) {
        if (i != date && !is_taken_[i] && time_stems_[i] == usual) return i;
      }
    }
    return std::nullopt;
  }

  void take_time_parts(std::size_t begin, std::size_t count) {
    take(Role::kTime, begin);
    for (std::size_t i = begin; i < begin + count; ++i) {
      is_taken_[i] = true;
      columns_.time_parts.push_back({i});
    }
  }

  /// Year, day of the year, and the time of the day behind them.
  bool choose_day_of_year() {
    for (std::size_t begin = 0; begin + 1 < header_.size(); ++begin) {
      const auto name = [&](std::size_t i) { return joined(words_of(header_[begin + i])); };
      if (!is_any_of(name(0), {"year", "yyyy", "yr", "jahr"}) ||
          !is_any_of(name(1), {"doy", "dayofyear", "jday", "julianday", "yday", "ddd"})) {
        continue;
      }
      const bool has_clock = begin + 2 < header_.size() &&
                             is_any_of(time_stems_[begin + 2], {"hour", "hh", "hr", "hhmm", "hrmn", "time", "mst",
                                                                "est", "cst", "pst", "lst", "utc", "gmt", "clock"});
      take_time_parts(begin, has_clock ? 3 : 2);
      columns_.time_parts[1].form = TimePartForm::kDayOfYear;
      for (const TimePart& part : columns_.time_parts) read_time_name(header_[part.column]);
      return true;
    }
    return false;
  }

  /// Year, month, day, hour, minute and second in columns side by side.
  bool choose_calendar_columns() {
    if (choose_day_of_year()) return true;
    constexpr std::size_t kParts = 6;
    static const std::array<std::initializer_list<std::string_view>, kParts> kNames = {
        {{"year", "yyyy", "yy", "yr", "jahr"},
         {"month", "mo", "mm", "monat"},
         {"day", "dd", "dy", "tag"},
         {"hour", "hh", "hr", "stunde"},
         {"minute", "min", "mn", "mm"},
         {"second", "sec", "ss"}}};
    for (std::size_t begin = 0; begin + 3 < header_.size(); ++begin) {
      std::size_t count = 0;
      while (count < kParts && begin + count < header_.size() &&
             is_any_of(joined(words_of(header_[begin + count])), kNames[count]))
        ++count;
      if (count < 4) continue;
      take_time_parts(begin, count);
      return true;
    }
    return false;
  }

  void read_time_name(std::string_view name) {
    if (!columns_.zone) columns_.zone = zone_in_name(name);
    const std::string text = lower(name);
    if (text.find("mm/dd") != std::string::npos || text.find("m/d/y") != std::string::npos)
      columns_.is_day_first = false;
    if (text.find("dd/mm") != std::string::npos || text.find("d/m/y") != std::string::npos ||
        text.find("dd.mm") != std::string::npos || text.find("dd-mm") != std::string::npos) {
      columns_.is_day_first = true;
    }
  }

  /// Components are searched for only if there is no speed, and vice versa.
  void choose_wind() {
    guess(Role::kGust);
    const bool wants_components = is_given(Role::kU) || is_given(Role::kV);
    if (!wants_components) guess(Role::kSpeed);
    if (columns_.at(Role::kSpeed)) {
      guess(Role::kDirection);
    } else {
      guess(Role::kU);
      guess(Role::kV);
    }
  }

  /// yuragi's own exports have further columns.
  void take_exported() {
    if (fmt::format("{}", fmt::join(header_, ",")) != kExportedHeader) return;
    const auto index_of = [this](std::string_view name) {
      return static_cast<std::size_t>(std::ranges::find(header_, name) - header_.begin());
    };
    if (!is_given(Role::kTime)) take(Role::kElapsed, index_of("time_s"));
    take(Role::kSensor, index_of("sensor"));
    take(Role::kQuality, index_of("quality"));
  }

  /// A speed that is not named a wind's, beside the places of a GPS.
  bool is_track() const {
    const auto& speed = columns_.at(Role::kSpeed);
    if (!speed || names_[speed->index].stem.find('w') != std::string::npos) return false;
    const auto has = [this](std::initializer_list<std::string_view> names) {
      return std::ranges::any_of(names_, [&](const Name& name) { return is_any_of(name.stem, names); });
    };
    return has({"lat", "latitude"}) && has({"lon", "lng", "long", "longitude"}) &&
           has({"course", "cog", "sog", "heading", "track", "ele", "elevation", "altitude", "alt", "hdop", "satellites",
                "sats", "fix"});
  }

  Result<Columns, Failure> checked() {
    if (columns_.time_parts.empty()) {
      return Failure{"no column looks like a time; the columns are " + listed(header_) +
                     "; name it with --time COLUMN (and --date COLUMN, if the date is in another), or skip lines "
                     "before the header with --skip N"};
    }
    return checked_wind();
  }

  Result<Columns, Failure> checked_wind() {
    if (!columns_.at(Role::kSpeed) && (!columns_.at(Role::kU) || !columns_.at(Role::kV))) {
      return Failure{"no column looks like a wind speed, nor two like u and v; the columns are " + listed(header_) +
                     "; name it with --speed COLUMN, or --u COLUMN --v COLUMN"};
    }
    if (!is_given(Role::kSpeed) && is_track()) {
      return Failure{"the speed in \"" + columns_.at(Role::kSpeed)->name +
                     "\" is that of a GPS, because places, a course or heights are beside it; if it is the wind's, "
                     "add --speed"};
    }
    for (const auto& column : columns_.by_role) {
      if (!column || columns_.time_parts.size() > 2) continue;
      if (std::ranges::count(header_, column->name) > 1) {
        return Failure{"the column \"" + column->name + "\" is duplicated in the header"};
      }
    }
    for (std::size_t i = 0; i < header_.size(); ++i) {
      if (!is_taken_[i] && !header_[i].empty()) columns_.unused.push_back(header_[i]);
    }
    return std::move(columns_);
  }

  const std::vector<std::string>& header_;
  const ColumnNames& given_;
  const std::vector<std::string>& row_;
  std::vector<bool> is_taken_;
  std::vector<Name> names_;
  std::vector<std::string> time_stems_;
  Columns columns_;
};

}  // namespace

Result<Columns, Failure> choose_keys(const std::vector<std::string>& keys, const ColumnNames& given,
                                     const std::vector<std::string>& values) {
  return ColumnChoice(keys, given, values).choose_of_keys();
}

Result<Columns, Failure> choose_columns(const std::vector<std::string>& header, const ColumnNames& given,
                                        const std::vector<std::string>& row) {
  return ColumnChoice(header, given, row).choose();
}

}  // namespace yuragi::daemon::tools::csv
