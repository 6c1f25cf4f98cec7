#include "daemon/tools/csv/csv_row.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "drivers/windlog/windlog_writer.hpp"
#include "engine/base/compass.hpp"
#include "engine/base/units.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

constexpr int kElapsedDecimals = 9;

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

std::string upper(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](char c) { return upper(c); });
  return result;
}

std::optional<std::string_view> field(const CsvFields& fields, CsvRole role) {
  return fields[static_cast<std::size_t>(role)];
}

/// Usual notations for a missing value.
bool is_missing(std::string_view text) {
  static constexpr std::array<std::string_view, 8> kWords = {"", "NAN", "NA", "N/A", "NULL", "NONE", "-", "--"};
  return text.size() <= 4 && std::find(kWords.begin(), kWords.end(), upper(text)) != kWords.end();
}

/// A finite number, with a point or a comma.
std::optional<double> parse_number(std::string_view text) {
  std::string plain(text.starts_with('+') ? text.substr(1) : text);
  std::replace(plain.begin(), plain.end(), ',', '.');
  double value = 0.0;
  const char* const end = plain.data() + plain.size();
  const auto [stop, error] = std::from_chars(plain.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// "no number "abc" in speed": the start of a field that may be anything.
Failure refusal(std::string_view what, std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string shown(text.substr(0, kShown));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c >= 0 && c < ' '; }, '?');
  return {std::string(what) + " \"" + shown + (text.size() > kShown ? "...\"" : "\"")};
}

}  // namespace

CsvRowReader::CsvRowReader(const CsvColumns& columns, const CsvImportOptions& options)
    : columns_(columns), options_(options), time_format_(options.time_format) {}

double CsvRowReader::unit_of(CsvRole role) const {
  if (options_.unit) return options_.unit->metres_per_second;
  const auto& column = columns_[static_cast<std::size_t>(role)];
  return column && column->unit ? column->unit->metres_per_second : 1.0;
}

Result<wind::WindReading, Failure> CsvRowReader::read(const CsvFields& fields) {
  wind::WindReading reading;
  if (const auto done = read_wind(fields, reading); !done) return done.error();

  const auto gust_m_s = read_speed(fields, CsvRole::kGust);
  if (!gust_m_s) return gust_m_s.error();
  if (*gust_m_s && **gust_m_s < 0.0) return refusal("gust below zero:", *field(fields, CsvRole::kGust));
  reading.gust_m_s = *gust_m_s;

  if (const auto quality = field(fields, CsvRole::kQuality)) {
    const auto* word = std::find(kQualityWords.begin(), kQualityWords.end(), *quality);
    if (word == kQualityWords.end()) return refusal("unknown quality:", *quality);
    reading.quality = static_cast<wind::ReadingQuality>(word - kQualityWords.begin());
  }
  if (!wind::is_plausible(reading)) {
    return Failure{"impossible wind: " + std::to_string(reading.speed_m_s) + " m/s" +
                   (reading.gust_m_s ? ", gust " + std::to_string(*reading.gust_m_s) + " m/s" : "")};
  }

  // The time comes last: only an accepted row advances it.
  const auto time = read_time(fields);
  if (!time) return time.error();
  reading.time = *time;
  return reading;
}

Result<Instant, Failure> CsvRowReader::read_time(const CsvFields& fields) {
  const std::string_view text = *field(fields, CsvRole::kTime);
  CsvTimeFormat format = time_format_;
  if (format == CsvTimeFormat::kAuto) {
    format = guess_time_format(text);
    const bool is_in_ms = columns_[static_cast<std::size_t>(CsvRole::kTime)]->is_in_ms;
    if (is_in_ms && format != CsvTimeFormat::kIso) format = CsvTimeFormat::kUnixMs;
  }
  const auto utc = parse_time(text, format);
  if (!utc) return refusal("not a time (" + std::string(name_of(format)) + "):", text);

  // Monotonic time: from yuragi's own export, or else UTC since the first row.
  Instant time{MonoTime(*utc - first_utc_.value_or(*utc)), *utc};
  if (const auto elapsed = field(fields, CsvRole::kElapsed)) {
    const auto ns = parse_decimal(*elapsed, kElapsedDecimals);
    if (!ns) return refusal("not a number of seconds:", *elapsed);
    time.mono = MonoTime(Nanoseconds(*ns));
  }
  wind::WindReading recordable;
  recordable.time = time;
  if (time.mono < last_) return refusal("time goes back:", text);
  if (!drivers::windlog::is_recordable(recordable)) return refusal("time out of range:", text);

  // The first accepted row determines the format of times.
  time_format_ = format;
  if (!first_utc_) first_utc_ = *utc;
  last_ = time.mono;
  return time;
}

Result<std::optional<double>, Failure> CsvRowReader::read_speed(const CsvFields& fields, CsvRole role) const {
  const auto text = field(fields, role);
  if (!text || is_missing(*text)) return std::optional<double>{};
  const auto number = parse_number(*text);
  if (!number) return refusal("not a number in " + std::string(name_of(role)) + ":", *text);
  return std::optional<double>(*number * unit_of(role));
}

/// Speed and direction, from themselves or from components.
Result<void, Failure> CsvRowReader::read_wind(const CsvFields& fields, wind::WindReading& reading) const {
  if (columns_[static_cast<std::size_t>(CsvRole::kSpeed)]) {
    const auto speed_m_s = read_speed(fields, CsvRole::kSpeed);
    if (!speed_m_s) return speed_m_s.error();
    if (!*speed_m_s) return Failure{"no speed"};
    if (**speed_m_s < 0.0) return refusal("speed below zero:", *field(fields, CsvRole::kSpeed));
    reading.speed_m_s = **speed_m_s;

    const auto direction = field(fields, CsvRole::kDirection);
    if (!direction) return {};
    const auto direction_deg = read_direction(*direction);
    if (!direction_deg) return direction_deg.error();
    reading.direction_deg = *direction_deg;
    return {};
  }

  const auto u_m_s = read_speed(fields, CsvRole::kU);
  if (!u_m_s) return u_m_s.error();
  const auto v_m_s = read_speed(fields, CsvRole::kV);
  if (!v_m_s) return v_m_s.error();
  if (!*u_m_s || !*v_m_s) return Failure{"no u or no v"};
  const wind::WindVector wind = (options_.components_are_from ? -1.0 : 1.0) * wind::WindVector{**u_m_s, **v_m_s};
  reading.speed_m_s = speed_of(wind);
  if (reading.speed_m_s > 0.0) reading.direction_deg = wind::direction_from_deg(wind);
  return {};
}

Result<std::optional<double>, Failure> CsvRowReader::read_direction(std::string_view text) const {
  if (is_missing(text)) return std::optional<double>{};

  // The name of a compass point, or a number in the unit of the column.
  double direction_deg = 0.0;
  if (const auto point_deg = compass_point_deg(text)) {
    direction_deg = *point_deg;
  } else {
    const auto number = parse_number(text);
    if (!number) return refusal("not a direction:", text);
    CsvDirectionUnit unit = options_.direction_unit;
    if (unit == CsvDirectionUnit::kAuto) {
      const auto& column = columns_[static_cast<std::size_t>(CsvRole::kDirection)];
      unit = column && column->is_in_radians ? CsvDirectionUnit::kRadians : CsvDirectionUnit::kDegrees;
    }
    direction_deg = *number;
    if (unit == CsvDirectionUnit::kRadians) direction_deg = *number / kRadPerDeg;
    if (unit == CsvDirectionUnit::kPoint16) direction_deg = *number * kDegPerCompassPoint;
  }

  // Both -180 to 180 and 0 to 360 are accepted, and a little more for rounding.
  constexpr double kTolerance_deg = 0.01;
  if (direction_deg < -180.0 - kTolerance_deg || direction_deg > 360.0 + kTolerance_deg) {
    return refusal("direction out of range:", text);
  }
  if (options_.direction_is_toward) direction_deg += 180.0;
  if (direction_deg < 0.0) direction_deg += 360.0;
  if (direction_deg >= 360.0) direction_deg -= 360.0;
  return std::optional<double>(direction_deg);
}

std::vector<std::string> CsvRowReader::describe() const {
  std::vector<std::string> lines;
  for (std::size_t index = 0; index < kCsvRoleCount; ++index) {
    if (!columns_[index]) continue;
    const CsvColumn& column = *columns_[index];
    const auto role = static_cast<CsvRole>(index);
    std::string line = std::string(name_of(role)) + " from \"" + column.name + "\"";
    const auto speed_unit = [&] {
      const drivers::sensor::SpeedUnit assumed{"m/s", 1.0};
      return std::string(options_.unit.value_or(column.unit.value_or(assumed)).name);
    };
    switch (role) {
      case CsvRole::kTime:
        line += " (" + std::string(name_of(time_format_)) +
                (time_format_ == CsvTimeFormat::kSeconds ? ", counted from 1970, since there is no date)"
                                                         : ", UTC if it has no zone)");
        break;
      case CsvRole::kSpeed:
      case CsvRole::kGust:
        line += " (" + speed_unit() + ")";
        break;
      case CsvRole::kU:
        line += " (" + speed_unit() + (options_.components_are_from ? ", from east)" : ", toward east)");
        break;
      case CsvRole::kV:
        line += " (" + speed_unit() + (options_.components_are_from ? ", from north)" : ", toward north)");
        break;
      case CsvRole::kDirection:
        line += options_.direction_is_toward ? " (where it blows to)" : " (where it comes from)";
        break;
      case CsvRole::kElapsed:
        line += " (s)";
        break;
      case CsvRole::kQuality:
      case CsvRole::kSensor:
        break;
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace yuragi::daemon::tools::csv
