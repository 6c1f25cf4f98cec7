#include "drivers/decode/text/nmea.hpp"

#include <charconv>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <system_error>

#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::text {
namespace {

using NmeaResult = Result<DecodedWind, Refusal>;
using NmeaValue = Result<std::optional<double>, Refusal>;

/// A single letter as a capital; any other text as it is.
std::string_view capital(std::string_view field) {
  constexpr std::string_view kCapitals = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";
  const bool is_small = field.size() == 1 && field[0] >= 'a' && field[0] <= 'z';
  return is_small ? kCapitals.substr(static_cast<std::size_t>(field[0] - 'a'), 1) : field;
}

/// Returns true if a word equals one in capitals, ignoring case.
bool is_word(std::string_view word, std::string_view capitals) {
  if (word.size() != capitals.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (capital(word.substr(i, 1)) != capitals.substr(i, 1)) return false;
  }
  return true;
}

/// The wind, with its direction. One that is impossible, or cannot be read, leaves the speed beside it, if there is
/// one.
NmeaResult with_direction(DecodedWind wind, const NmeaValue& direction_deg) {
  if (!direction_deg && !wind.speed_m_s) return direction_deg.error();
  if (direction_deg) wind.direction_deg = *direction_deg;
  return checked(wind);
}

/// MWV and XDR know miles per hour too.
std::optional<double> sentence_unit(std::string_view field) {
  const std::string_view letter = capital(field);
  return letter == "S" ? kMetresPerSecondPerMph : metres_per_second_of(letter);
}

/// The speed in field `at`, whose unit is in the next field.
NmeaValue speed_with_unit(const TextFields& fields, std::size_t at) {
  const NmeaValue number = parse_number(fields[at]);
  if (!number || !*number) return number;
  const auto factor = sentence_unit(fields[at + 1]);
  if (!factor) return Refusal::kMalformed;
  return std::optional(**number * *factor);
}

/// The speed in the first of these fields that is not empty; each must have the letter that the sentence prescribes.
struct SpeedPlace {
  std::size_t at;
  std::string_view letter;
};
NmeaValue first_speed(const TextFields& fields, std::initializer_list<SpeedPlace> places) {
  for (const SpeedPlace& place : places) {
    if (fields[place.at].empty()) continue;
    if (capital(fields[place.at + 1]) != place.letter) return Refusal::kMalformed;
    return speed_with_unit(fields, place.at);
  }
  return std::optional<double>();
}

/// $--MWV,angle,R|T,speed,K|N|M|S,A|V
NmeaResult decode_mwv(const NmeaOptions& options, const TextFields& fields) {
  DecodedWind wind;

  // The status first: the other fields of an invalid sentence do not matter.
  const std::string_view status = capital(fields[5]);
  if (status.empty()) {
    if (options.status == WhenMissing::kRefuse) return Refusal::kMalformed;
    wind.status = DecodedStatus::kUncertain;
  } else if (!is_good_status(status)) {
    return Refusal::kInvalid;
  }

  if (capital(fields[2]) == "R") {
    wind.reference = WindReference::kRelative;
  } else if (capital(fields[2]) == "T") {
    wind.reference = WindReference::kTrue;
  } else if (!fields[2].empty()) {
    return Refusal::kMalformed;
  }

  const NmeaValue speed_m_s = speed_with_unit(fields, 3);
  if (!speed_m_s) return speed_m_s.error();
  wind.speed_m_s = *speed_m_s;
  return with_direction(wind, parse_direction_deg(fields[1]));
}

/// The pairs deg,T,deg,M,kn,N,m/s,M that MWD and MDA share, from field `at` on. A pair can be absent, also with its
/// letter: the letters determine what the numbers are. M is magnetic north in one of the first two pairs; it is m/s in
/// the others, and behind M or N.
NmeaResult decode_north(const TextFields& fields, std::size_t at) {
  constexpr std::size_t kDirectionPairs = 2;
  constexpr std::size_t kPairs = 4;
  std::string_view true_deg;
  std::string_view magnetic_deg;
  std::optional<std::size_t> knots_at;
  std::optional<std::size_t> metres_at;
  bool has_magnetic = false;
  bool has_unknown_direction = false;
  for (std::size_t pair = 0; pair < kPairs; ++pair) {
    const std::size_t number = at + 2 * pair;
    const std::string_view letter = capital(fields[number + 1]);
    const bool can_be_direction = pair < kDirectionPairs && !knots_at && !has_magnetic;
    if (letter == "T" && can_be_direction) {
      true_deg = fields[number];
    } else if (letter == "M" && can_be_direction) {
      magnetic_deg = fields[number];
      has_magnetic = true;
    } else if (letter == "N") {
      knots_at = number;
    } else if (letter == "M") {
      metres_at = number;
    } else if (!fields[number].empty()) {
      if (pair >= kDirectionPairs) return Refusal::kMalformed;
      has_unknown_direction = true;
    }
  }

  DecodedWind wind;
  for (const auto& speed_at : {metres_at, knots_at}) {
    if (!speed_at || fields[*speed_at].empty()) continue;
    const NmeaValue speed_m_s = speed_with_unit(fields, *speed_at);
    if (!speed_m_s) return speed_m_s.error();
    wind.speed_m_s = *speed_m_s;
    break;
  }
  const bool is_true = !true_deg.empty();
  if (!is_true && magnetic_deg.empty() && has_unknown_direction) return with_direction(wind, Refusal::kMalformed);
  const NmeaValue direction_deg = parse_direction_deg(is_true ? true_deg : magnetic_deg);
  if (direction_deg && *direction_deg) wind.reference = is_true ? WindReference::kNorth : WindReference::kMagnetic;
  return with_direction(wind, direction_deg);
}

/// $--VWR and VWT,0..180,L|R,kn,N,m/s,M,km/h,K
NmeaResult decode_side(const TextFields& fields, WindReference reference) {
  const NmeaValue angle_deg = parse_direction_deg(fields[1]);
  const NmeaValue speed_m_s = first_speed(fields, {{5, "M"}, {3, "N"}, {7, "K"}});
  if (!speed_m_s) return speed_m_s.error();

  DecodedWind wind;
  wind.speed_m_s = *speed_m_s;
  wind.reference = reference;
  if (!angle_deg || !*angle_deg) return with_direction(wind, angle_deg);
  const bool is_port = capital(fields[2]) == "L";
  if (!is_port && capital(fields[2]) != "R") return with_direction(wind, Refusal::kMalformed);
  return with_direction(wind, wrapped_direction_deg(is_port ? 360.0 - **angle_deg : **angle_deg));
}

/// The statistic (minimum, mean, maximum) of an XDR quadruple, by its id.
enum class XdrRole : std::uint8_t { kNone, kLeast, kMean, kGreatest };

/// Only a number is one: a boat's heel is an angle too, and its id is HEEL.
XdrRole xdr_role(std::string_view id, int first_id) {
  int number = 0;
  const char* const end = id.data() + id.size();
  const auto [stop, error] = std::from_chars(id.data(), end, number);
  if (id.empty() || error != std::errc() || stop != end || number < first_id) return XdrRole::kNone;
  switch (number - first_id) {
    case 0:
      return XdrRole::kLeast;
    case 1:
      return XdrRole::kMean;
    case 2:
      return XdrRole::kGreatest;
    default:
      return XdrRole::kNone;
  }
}

/// Returns true if these are quadruples, each with a type of one letter. If a field is lost, the following ones move
/// up, and are not quadruples. The text after the last one must be empty.
bool are_xdr_quadruples(const TextFields& fields) {
  std::size_t at = 1;
  for (; at + 3 < fields.count; at += 4) {
    const std::string_view type = fields[at];
    const bool is_type = type.empty() || (type.size() == 1 && type[0] >= 'A' && type[0] <= 'Z');
    if (!is_type) return false;
  }
  for (; at < fields.count; ++at) {
    if (!fields[at].empty()) return false;
  }
  return true;
}

/// Minimum, mean and maximum of one quantity, as far as a sentence has them.
struct XdrStatistics {
  std::optional<double> least;
  std::optional<double> mean;
  std::optional<double> greatest;

  void take(XdrRole role, std::optional<double> value) {
    if (role == XdrRole::kLeast) least = value;
    if (role == XdrRole::kMean) mean = value;
    if (role == XdrRole::kGreatest) greatest = value;
  }
  /// A device that sends only the first id has its reading there; beside a greatest value it is the least one.
  std::optional<double> reading() const { return mean || greatest ? mean : least; }
};

/// $--XDR and quadruples of type, value, unit, id. The mean is the reading and the greatest speed the gust.
NmeaResult decode_xdr(const NmeaOptions& options, const TextFields& fields) {
  bool has_wind = false;
  std::optional<Refusal> angle_refusal;  // an angle that cannot be read leaves the others
  XdrStatistics angles_deg;
  XdrStatistics speeds_m_s;

  if (!are_xdr_quadruples(fields)) return Refusal::kMalformed;
  for (std::size_t at = 1; at + 3 < fields.count; at += 4) {
    const bool is_angle = fields[at] == "A" && fields[at + 2] == "D";
    const bool is_speed = fields[at] == "S" && sentence_unit(fields[at + 2]);
    const XdrRole role = is_angle || is_speed ? xdr_role(fields[at + 3], options.xdr_first_id) : XdrRole::kNone;
    if (role == XdrRole::kNone) continue;
    has_wind = true;

    const NmeaValue value = is_angle ? parse_direction_deg(fields[at + 1]) : speed_with_unit(fields, at + 1);
    if (!value && is_angle) {
      angle_refusal = value.error();
      continue;
    }
    if (!value) return value.error();
    (is_angle ? angles_deg : speeds_m_s).take(role, *value);
  }
  if (!has_wind) return Refusal::kNotMine;

  DecodedWind wind;
  wind.reference = WindReference::kRelative;
  wind.direction_deg = angles_deg.reading();
  wind.speed_m_s = speeds_m_s.reading();
  wind.gust_m_s = speeds_m_s.greatest;
  const bool is_nothing_else = !wind.speed_m_s && !wind.direction_deg && !wind.gust_m_s;
  if (angle_refusal && is_nothing_else) return *angle_refusal;
  return checked(wind);
}

constexpr double kHectopascalsPerBar = 1000.0;
constexpr double kHectopascalsPerPascal = 0.01;
constexpr double kHectopascalsPerInchOfMercury = 33.86389;  // at 0 degrees Celsius

/// Returns a number times a factor; nullopt if there is none.
std::optional<double> scaled(std::string_view field, double factor) {
  const NmeaValue number = parse_number(field);
  if (!number || !*number) return std::nullopt;
  return **number * factor;
}

/// $--MDA,inHg,I,bar,B,air,C,water,C,relative humidity,absolute humidity,dew point,C,...
wind::StationQuantities quantities_of_mda(const TextFields& fields) {
  wind::StationQuantities said;
  if (fields[4] == "B") said.pressure_hpa = scaled(fields[3], kHectopascalsPerBar);
  if (!said.pressure_hpa && fields[2] == "I") said.pressure_hpa = scaled(fields[1], kHectopascalsPerInchOfMercury);
  if (fields[6] == "C") said.air_temperature_c = scaled(fields[5], 1.0);
  said.relative_humidity_percent = scaled(fields[9], 1.0);
  return said;
}

std::optional<double> xdr_pressure_hpa(std::string_view value, std::string_view unit) {
  if (unit == "B") return scaled(value, kHectopascalsPerBar);
  if (unit == "P") return scaled(value, kHectopascalsPerPascal);
  if (unit == "H") return scaled(value, 1.0);
  return std::nullopt;
}

wind::StationQuantities quantities_of_xdr(const TextFields& fields, int first_id) {
  wind::StationQuantities said;
  for (std::size_t at = 1; at + 3 < fields.count; at += 4) {
    if (xdr_role(fields[at + 3], first_id) != XdrRole::kLeast) continue;  // the first of the numbers
    const std::string_view type = fields[at];
    const std::string_view value = fields[at + 1];
    const std::string_view unit = fields[at + 2];
    if (type == "C" && unit == "C") said.air_temperature_c = scaled(value, 1.0);
    if (type == "P") said.pressure_hpa = xdr_pressure_hpa(value, unit);
    if (type == "H" && unit == "P") said.relative_humidity_percent = scaled(value, 1.0);
    if (type == "V" && unit == "M") said.rain_total_mm = scaled(value, 1.0);
    if (type == "R" && unit == "M") said.rain_rate_mm_h = scaled(value, 1.0);
  }
  return said;
}

}  // namespace

std::optional<wind::StationQuantities> decode_nmea_quantities(const NmeaOptions& options,
                                                              std::string_view line) noexcept {
  const auto sentence = sentence_of(line, options.checksum);
  if (!sentence) return std::nullopt;
  const TextFields fields = split_fields(*sentence, ',');
  const bool is_mda = fields[0].ends_with("MDA");
  const bool is_xdr = fields[0].ends_with("XDR");
  constexpr std::size_t kTalkerAndSentence = 5;
  if (fields[0].size() != kTalkerAndSentence || !fields.are_all || (!is_mda && !is_xdr)) return std::nullopt;
  if (is_xdr && !are_xdr_quadruples(fields)) return std::nullopt;
  const wind::StationQuantities said =
      is_mda ? quantities_of_mda(fields) : quantities_of_xdr(fields, options.xdr_first_id);
  for (const wind::StationQuantity& each : wind::kStationQuantities) {
    if (said.*each.value) return said;
  }
  return std::nullopt;
}

NmeaResult decode_nmea(const NmeaOptions& options, std::string_view line) noexcept {
  const auto sentence = sentence_of(line, options.checksum);
  if (!sentence) return sentence.error();
  const TextFields fields = split_fields(*sentence, ',');

  // Two characters of talker, three of sentence.
  constexpr std::size_t kTalker = 2;
  if (fields[0].size() != kTalker + 3) return Refusal::kNotMine;
  const std::string_view name = fields[0].substr(kTalker);
  const auto is = [name](std::string_view capitals) { return is_word(name, capitals); };
  if (!is("MWV") && !is("MWD") && !is("VWR") && !is("VWT") && !is("MDA") && !is("XDR")) return Refusal::kNotMine;
  if (!fields.are_all) return Refusal::kMalformed;

  if (is("MWV")) return decode_mwv(options, fields);
  if (is("MWD")) return decode_north(fields, 1);
  if (is("MDA")) return decode_north(fields, 13);
  if (is("XDR")) return decode_xdr(options, fields);
  return decode_side(fields, is("VWR") ? WindReference::kRelative : WindReference::kTrue);
}

}  // namespace yuragi::drivers::decode::text
