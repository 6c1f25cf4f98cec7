#include "daemon/tools/csv/csv_row.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_lines.hpp"
#include "daemon/tools/csv/csv_value.hpp"
#include "daemon/tools/csv/csv_words.hpp"
#include "drivers/windlog/windlog_writer.hpp"
#include "engine/base/compass.hpp"
#include "engine/base/count_text.hpp"
#include "engine/base/units.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

constexpr int kElapsedDecimals = 9;
constexpr std::size_t kMaxOddDirections = 5;

bool is_ascii(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

/// The start of a field with any content.
std::string shown(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string start(text.substr(0, kShown));
  std::replace_if(
      start.begin(), start.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  return "\"" + start + (text.size() > kShown ? "...\"" : "\"");
}

RowRefusal refusal(std::string reason, std::string_view text) {
  return {.reason = std::move(reason), .text = shown(text)};
}

}  // namespace

Result<RowReader, Failure> RowReader::make(const Layout& layout, const Survey& survey, const ImportOptions& options) {
  RowReader reader(layout, survey, options);
  reader.zone_source_ = "because the file names no zone; --zone changes that";
  if (options.zone) {
    reader.zone_ = *options.zone;
    reader.zone_source_ = "by --zone";
  } else if (layout.columns.zone) {
    const auto zone = Zone::parse(*layout.columns.zone);
    if (!zone) return zone.error();
    reader.zone_ = *zone;
    reader.zone_source_ = "as the file states";
  }
  return reader;
}

bool RowReader::is_missing(Role role, std::string_view text) const {
  if (is_missing_word(text)) return true;
  const auto number = parse_number(text, dimension_of(role));
  for (const std::string& missing : options_.missing) {
    const auto mark = parse_number(missing, Dimension::kNone);
    if (text == missing || (number && mark && number->value == mark->value)) return true;
  }
  if (!number) return false;
  const Unit unit = number->unit.value_or(unit_of(role));
  return is_missing_number(role, number->value, in_base(unit, number->value)) ||
         number->value == survey_.missing_mark[static_cast<std::size_t>(role)];
}

Unit RowReader::unit_of(Role role) const {
  const auto& column = columns_.at(role);
  return column && column->unit ? *column->unit : Unit{};
}

Result<Row, RowRefusal> RowReader::read(const Fields& fields) {
  Row row;
  wind::Reading& reading = row.reading;
  if (const auto done = read_wind(fields, reading); !done) return done.error();

  const auto gust_m_s = read_speed(fields, Role::kGust);
  if (!gust_m_s) return gust_m_s.error();
  if (*gust_m_s && **gust_m_s < 0.0) return refusal("gust below zero", *fields.at(Role::kGust));
  reading.gust_m_s = *gust_m_s;

  if (const auto quality = fields.at(Role::kQuality)) {
    const auto* word = std::find(kQualityWords.begin(), kQualityWords.end(), *quality);
    if (word == kQualityWords.end()) return refusal("unknown quality", *quality);
    reading.quality = static_cast<wind::ReadingQuality>(word - kQualityWords.begin());
  }
  if (!wind::is_plausible(reading)) {
    return RowRefusal{.reason = "impossible wind (check --unit; if it is a mark for no value, add --missing)",
                      .text = std::to_string(reading.speed_m_s) + " m/s" +
                              (reading.gust_m_s ? ", gust " + std::to_string(*reading.gust_m_s) + " m/s" : "")};
  }

  // The time comes last: only an accepted row advances it.
  const auto time = read_time(fields);
  if (!time) return time.error();
  reading.time = *time;
  row.quantities = read_quantities(fields, *time);
  return row;
}

Result<Instant, RowRefusal> RowReader::read_time(const Fields& fields) {
  const std::string_view text = fields.time;
  const auto written = parse_time(text, survey_.time_format);
  if (!written) return refusal("not a time (" + std::string(name_of(survey_.time_format)) + "; --time-format)", text);
  const UtcTime clock = survey_.typical_year ? in_typical_year(written->clock) : written->clock;
  UtcTime utc = clock;
  if (written->utc_offset) {
    utc -= *written->utc_offset;
  } else {
    const auto known = zone_.to_utc(clock, last_utc_);
    if (!known) return refusal("a time that does not exist in " + zone_.name() + " (check --zone)", text);
    utc = *known;
  }

  // Monotonic time: from yuragi's own export, or else UTC since the first row.
  Instant time{MonoTime(utc - first_utc_.value_or(utc)), utc};
  if (const auto elapsed = fields.at(Role::kElapsed)) {
    const auto ns = parse_decimal(*elapsed, kElapsedDecimals);
    if (!ns) return refusal("not a number of seconds", *elapsed);
    time.mono = MonoTime(Nanoseconds(*ns));
  }
  wind::Reading recordable;
  recordable.time = time;
  if (time.mono < last_) {
    ++went_back_;
    return refusal("time goes back", text);
  }
  if (!drivers::windlog::is_recordable(recordable)) return refusal("time out of range", text);

  if (first_utc_ && time.mono == last_) ++same_time_;
  ++(written->utc_offset ? zoned_ : unzoned_);
  if (!first_utc_) first_utc_ = utc;
  last_ = time.mono;
  last_utc_ = utc;
  return time;
}

UtcTime RowReader::in_typical_year(UtcTime clock) const {
  const auto day = std::chrono::floor<std::chrono::days>(clock);
  const std::chrono::year_month_day ymd(day);
  // The last hour of the last day ends in the next year.
  const bool is_end =
      first_utc_ && ymd.month() == std::chrono::January && unsigned(ymd.day()) == 1 && clock == UtcTime(day);
  const std::chrono::year year = *survey_.typical_year + std::chrono::years(is_end ? 1 : 0);
  return UtcTime(std::chrono::sys_days(year / ymd.month() / ymd.day())) + (clock - day);
}

Result<std::optional<double>, RowRefusal> RowReader::read_number(const Fields& fields, Role role) {
  const auto text = fields.at(role);
  if (!text) return std::optional<double>{};
  if (is_missing(role, *text)) {
    if (!text->empty()) ++missing_[static_cast<std::size_t>(role)];
    return std::optional<double>{};
  }
  const auto number = parse_number(*text, dimension_of(role));
  if (!number) return refusal("not a number in " + std::string(name_of(role)), *text);
  const Unit unit = number->unit.value_or(unit_of(role));
  return std::optional<double>(in_base(unit, number->value));
}

Result<std::optional<double>, RowRefusal> RowReader::read_speed(const Fields& fields, Role role) {
  // A calm in words is a speed.
  if (const auto text = fields.at(role); text && text->size() == 4 && text->front() > '9' && lower(*text) == "calm")
    return std::optional(0.0);
  return read_number(fields, role);
}

/// Speed and direction, from themselves or from components.
Result<void, RowRefusal> RowReader::read_wind(const Fields& fields, wind::Reading& reading) {
  if (const auto speed = fields.at(Role::kSpeed)) {
    if (std::ranges::count(*speed, ',') == 4) return read_packed_wind(*speed, reading);
    const auto speed_m_s = read_speed(fields, Role::kSpeed);
    if (!speed_m_s) return speed_m_s.error();
    if (!*speed_m_s) return RowRefusal{"no speed"};
    if (**speed_m_s < 0.0) return refusal("speed below zero", *speed);
    reading.speed_m_s = **speed_m_s;
    const auto direction = fields.at(Role::kDirection);
    if (direction) reading.direction_deg = read_direction(*direction);
    return {};
  }

  const auto u_m_s = read_number(fields, Role::kU);
  if (!u_m_s) return u_m_s.error();
  const auto v_m_s = read_number(fields, Role::kV);
  if (!v_m_s) return v_m_s.error();
  if (!*u_m_s || !*v_m_s) return RowRefusal{"no u or no v"};
  const wind::Vector wind = (options_.components_are_from ? -1.0 : 1.0) * wind::Vector{**u_m_s, **v_m_s};
  reading.speed_m_s = speed_of(wind);
  if (reading.speed_m_s > 0.0) reading.direction_deg = wind::direction_from_deg(wind);
  return {};
}

/// The field WND of NOAA's Integrated Surface Database: "310,1,N,0051,1" is 310 degrees, 5.1 m/s.
Result<void, RowRefusal> RowReader::read_packed_wind(std::string_view text, wind::Reading& reading) {
  std::string copy(text);
  std::vector<std::string_view> parts;
  if (!split_csv_line(copy, ',', parts) || parts.size() != 5) return refusal("not a wind in NOAA's format", text);
  const auto direction = parse_number(parts[0], Dimension::kNone);
  const auto speed = parse_number(parts[3], Dimension::kNone);
  if (!direction || !speed) return refusal("not a wind in NOAA's format", text);
  constexpr double kNoDirection = 999.0;
  constexpr double kNoSpeed = 9999.0;
  constexpr double kTenth = 0.1;
  if (speed->value == kNoSpeed) return RowRefusal{"no speed"};
  reading.speed_m_s = speed->value * kTenth;
  if (direction->value != kNoDirection) reading.direction_deg = read_direction(parts[0]);
  return {};
}

/// Nullopt if the field is not a direction; the speed beside it is still valid.
std::optional<double> RowReader::read_direction(std::string_view text) {
  if (is_missing(Role::kDirection, text)) {
    if (!text.empty()) ++missing_[static_cast<std::size_t>(Role::kDirection)];
    return std::nullopt;
  }
  // The name of a compass point, or a number in the unit of the column.
  static const std::map<std::string, double, std::less<>> kWords = {
      {"north", 0.0}, {"east", 90.0}, {"south", 180.0}, {"west", 270.0}};
  const bool is_name = (text[0] < '0' || text[0] > '9') && text[0] != '-';
  std::optional<double> direction_deg = is_name ? compass_point_deg(text) : std::nullopt;
  if (!direction_deg && is_name && !is_ascii(text)) direction_deg = compass_point_deg(joined(words_of(text)));
  if (!direction_deg && is_name) {
    if (const auto word = kWords.find(lower(text.substr(0, 6))); word != kWords.end()) direction_deg = word->second;
  }
  if (!direction_deg) {
    const auto number = parse_number(text, Dimension::kDirection);
    if (number) direction_deg = in_base(number->unit.value_or(unit_of(Role::kDirection)), number->value);
  }

  // Both -180 to 180 and 0 to 360 are accepted, and a little more for rounding.
  constexpr double kTolerance_deg = 0.01;
  if (!direction_deg || *direction_deg < -180.0 - kTolerance_deg || *direction_deg > 360.0 + kTolerance_deg) {
    const std::string odd = shown(text);
    if (odd_directions_.contains(odd) || odd_directions_.size() < kMaxOddDirections) {
      ++odd_directions_[odd];
    } else {
      ++odd_directions_["others"];
    }
    return std::nullopt;
  }
  if (options_.direction_is_toward) *direction_deg += 180.0;
  if (*direction_deg < 0.0) *direction_deg += 360.0;
  if (*direction_deg >= 360.0) *direction_deg -= 360.0;
  return direction_deg;
}

std::optional<wind::StationQuantities> RowReader::read_quantities(const Fields& fields, const Instant& time) {
  if (std::ranges::none_of(kQuantityRoles, [this](Role role) { return columns_.at(role).has_value(); }))
    return std::nullopt;
  wind::StationQuantities quantities;
  quantities.time = time;
  for (std::size_t i = 0; i < kQuantityRoles.size(); ++i) {
    const auto value = read_number(fields, kQuantityRoles[i]);
    if (!value) {
      ++implausible_quantities_;
      continue;
    }
    const wind::StationQuantity& range = wind::kStationQuantities[i];
    if (*value && (**value < range.least || **value > range.greatest)) ++implausible_quantities_;
    quantities.*range.value = *value;
  }
  return wind::plausible_part(quantities);
}

std::string RowReader::describe_time() const {
  std::string text(name_of(survey_.time_format));
  if (survey_.time_format == TimeFormat::kSeconds) return text + ", counted from 1970, because there is no date";
  if (!is_calendar(survey_.time_format)) return text;
  if (zoned_ > 0) text += ", with zones of their own";
  if (unzoned_ > 0) text += ", in " + zone_.name() + " " + zone_source_;
  return text;
}

std::vector<std::string> RowReader::describe() const {
  std::vector<std::string> lines;
  for (std::size_t index = 0; index < kCsvRoleCount; ++index) {
    if (!columns_.by_role[index]) continue;
    const Column& column = *columns_.by_role[index];
    const auto role = static_cast<Role>(index);
    std::string line = std::string(name_of(role)) + " from \"" + column.name + "\"";
    const auto unit = [&] { return column.unit ? std::string(column.unit->name) + ", " : std::string(); };
    switch (role) {
      case Role::kTime:
        line += " (" + describe_time() + ")";
        break;
      case Role::kU:
        line +=
            " (" + unit() + (options_.components_are_from ? "from east; " : "toward east; ") + column.unit_source + ")";
        break;
      case Role::kV:
        line += " (" + unit() + (options_.components_are_from ? "from north; " : "toward north; ") +
                column.unit_source + ")";
        break;
      case Role::kDirection:
        line += options_.direction_is_toward ? " (where it blows to" : " (where it comes from";
        line += fmt::format(", in {})", unit_of(role).name);
        break;
      case Role::kElapsed:
        line += " (s)";
        break;
      case Role::kDate:
      case Role::kQuality:
      case Role::kSensor:
        break;
      default:
        line += " (" + unit() + column.unit_source + ")";
        break;
    }
    lines.push_back(line);
  }
  if (!columns_.unused.empty()) {
    lines.push_back(fmt::format("not taken: {}", fmt::join(columns_.unused, ", ")));
  }
  return lines;
}

std::vector<std::string> RowReader::notes() const {
  std::vector<std::string> lines;
  for (std::size_t index = 0; index < kCsvRoleCount; ++index) {
    if (missing_[index] == 0) continue;
    lines.push_back(fmt::format("{}: {} left empty, marked as missing", name_of(static_cast<Role>(index)),
                                count_text(missing_[index], "value")));
  }
  for (const auto& [text, count] : odd_directions_) {
    lines.push_back(
        fmt::format("direction: {} is not a direction and was left empty, {} times; the speed was used", text, count));
  }
  if (implausible_quantities_ > 0) {
    lines.push_back("weather: " + count_text(implausible_quantities_, "value") +
                    " left out, because they are impossible");
  }
  if (same_time_ > 0) {
    lines.push_back("the same time as the one before: " + count_text(same_time_, "reading") +
                    ", kept a nanosecond apart; are the times rounded?");
  }
  if (went_back_ > 0) {
    lines.push_back(count_text(went_back_, "row") + " go back in time and are left out: " +
                    (unzoned_ > 0 ? "if the clock changed to winter time, add --zone (such as Europe/Berlin); " : "") +
                    "if there are several stations, choose one with --where COLUMN=VALUE");
  }
  return lines;
}

}  // namespace yuragi::daemon::tools::csv
