#include "daemon/tools/csv/csv_units.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "daemon/tools/csv/csv_words.hpp"
#include "drivers/decode/speed_units.hpp"
#include "engine/base/units.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

struct NamedUnit {
  std::string_view plain;  ///< in lower case, without punctuation
  Unit unit;
};

/// Beaufort's scale by its formula of 1946: the speed in the middle of a force is 0.836 m/s times its power 1.5.
constexpr Unit kBeaufort{"Bft", 0.836, 0.0, 1.5};

/// The words of drivers/decode, in lower case and without punctuation, and those of tables only.
std::span<const NamedUnit> speed_units() {
  static const auto kPlainWords = [] {
    std::array<std::string, drivers::decode::kSpeedWords.size()> plain;
    std::ranges::transform(drivers::decode::kSpeedWords, plain.begin(),
                           [](const drivers::decode::SpeedWord& each) { return joined(words_of(each.word)); });
    return plain;
  }();
  static const auto kUnits = [] {
    std::vector<NamedUnit> units;
    for (std::size_t i = 0; i < kPlainWords.size(); ++i) {
      const drivers::decode::SpeedUnit& unit = drivers::decode::kSpeedWords[i].unit;
      units.push_back({kPlainWords[i], {unit.name, unit.metres_per_second}});
    }
    units.push_back({"01ms", {"0.1 m/s", 0.1}});
    for (const std::string_view word : {"bft", "bf", "beaufort"}) units.push_back({word, kBeaufort});
    return units;
  }();
  return kUnits;
}

constexpr Unit kDegrees{"degrees"};
constexpr Unit kRadians{"radians", 1.0 / kRadPerDeg};
constexpr Unit kTensOfDegrees{"tens of degrees", 10.0};
constexpr std::array kDirectionUnits = {NamedUnit{"deg", kDegrees},
                                        NamedUnit{"degree", kDegrees},
                                        NamedUnit{"degrees", kDegrees},
                                        NamedUnit{"degt", kDegrees},
                                        NamedUnit{"degn", kDegrees},
                                        NamedUnit{"degfromn", kDegrees},
                                        NamedUnit{"degreesnorth", kDegrees},
                                        NamedUnit{"degreestrue", kDegrees},
                                        NamedUnit{"rad", kRadians},
                                        NamedUnit{"radian", kRadians},
                                        NamedUnit{"radians", kRadians},
                                        NamedUnit{"degm", kDegrees},
                                        NamedUnit{"grad", kDegrees},
                                        NamedUnit{"degres", kDegrees},
                                        NamedUnit{"gradi", kDegrees},
                                        NamedUnit{"graden", kDegrees},
                                        NamedUnit{"grados", kDegrees},
                                        NamedUnit{"compass", kDegrees},
                                        NamedUnit{"compasspoint", kDegrees},
                                        NamedUnit{"cardinal", kDegrees},
                                        NamedUnit{"compasspoints", kDegrees},
                                        NamedUnit{"10sdeg", kTensOfDegrees},
                                        NamedUnit{"10deg", kTensOfDegrees},
                                        NamedUnit{"10degrees", kTensOfDegrees},
                                        NamedUnit{"10sofdegrees", kTensOfDegrees},
                                        NamedUnit{"tensofdegrees", kTensOfDegrees}};

constexpr Unit kCelsius{"C"};
constexpr Unit kFahrenheit{"F", 5.0 / 9.0, -32.0 * 5.0 / 9.0};
constexpr Unit kKelvin{"K", 1.0, -273.15};
constexpr Unit kTenthsOfCelsius{"0.1 C", 0.1};
constexpr std::array kTemperatureUnits = {NamedUnit{"c", kCelsius},
                                          NamedUnit{"degc", kCelsius},
                                          NamedUnit{"celsius", kCelsius},
                                          NamedUnit{"degcelsius", kCelsius},
                                          NamedUnit{"degreescelsius", kCelsius},
                                          NamedUnit{"degreesc", kCelsius},
                                          NamedUnit{"f", kFahrenheit},
                                          NamedUnit{"degf", kFahrenheit},
                                          NamedUnit{"fahrenheit", kFahrenheit},
                                          NamedUnit{"degreesf", kFahrenheit},
                                          NamedUnit{"k", kKelvin},
                                          NamedUnit{"kelvin", kKelvin},
                                          NamedUnit{"01degreescelsius", kTenthsOfCelsius},
                                          NamedUnit{"01c", kTenthsOfCelsius}};

constexpr Unit kHectopascals{"hPa"};
constexpr Unit kPascals{"Pa", 0.01};
constexpr Unit kKilopascals{"kPa", 10.0};
constexpr Unit kInchesOfMercury{"inHg", 33.8638866667};  // of 0 degrees Celsius: NIST SP 811, appendix B.8
constexpr Unit kMillimetresOfMercury{"mmHg", 1.33322387415};
constexpr Unit kTenthsOfHectopascals{"0.1 hPa", 0.1};
constexpr std::array kPressureUnits = {
    NamedUnit{"hpa", kHectopascals},          NamedUnit{"mb", kHectopascals},
    NamedUnit{"mbar", kHectopascals},         NamedUnit{"pa", kPascals},
    NamedUnit{"kpa", kKilopascals},           NamedUnit{"inhg", kInchesOfMercury},
    NamedUnit{"in", kInchesOfMercury},        NamedUnit{"mmhg", kMillimetresOfMercury},
    NamedUnit{"01hpa", kTenthsOfHectopascals}};

constexpr std::array kHumidityUnits = {NamedUnit{"percent", Unit{"percent"}}, NamedUnit{"pct", Unit{"percent"}},
                                       NamedUnit{"rh", Unit{"percent"}}};

constexpr double kMillimetresPerInch = 25.4;
constexpr std::array kRainUnits = {NamedUnit{"mm", Unit{"mm"}},
                                   NamedUnit{"millimeters", Unit{"mm"}},
                                   NamedUnit{"cm", Unit{"cm", 10.0}},
                                   NamedUnit{"in", Unit{"in", kMillimetresPerInch}},
                                   NamedUnit{"inch", Unit{"in", kMillimetresPerInch}},
                                   NamedUnit{"inches", Unit{"in", kMillimetresPerInch}}};
constexpr std::array kRainRateUnits = {
    NamedUnit{"mmh", Unit{"mm/h"}}, NamedUnit{"mmhr", Unit{"mm/h"}}, NamedUnit{"cmh", Unit{"cm/h", 10.0}},
    NamedUnit{"inh", Unit{"in/h", kMillimetresPerInch}}, NamedUnit{"inhr", Unit{"in/h", kMillimetresPerInch}}};

constexpr std::array kTimeUnits = {NamedUnit{"ms", Unit{"ms"}}, NamedUnit{"s", Unit{"s"}}, NamedUnit{"sec", Unit{"s"}},
                                   NamedUnit{"seconds", Unit{"s"}}, NamedUnit{"milliseconds", Unit{"ms"}}};

std::span<const NamedUnit> units_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::kTime:
      return kTimeUnits;
    case Dimension::kSpeed:
      return speed_units();
    case Dimension::kDirection:
      return kDirectionUnits;
    case Dimension::kTemperature:
      return kTemperatureUnits;
    case Dimension::kPressure:
      return kPressureUnits;
    case Dimension::kHumidity:
      return kHumidityUnits;
    case Dimension::kRain:
      return kRainUnits;
    case Dimension::kRainRate:
      return kRainRateUnits;
    case Dimension::kNone:
      break;
  }
  return {};
}

}  // namespace

double in_base(const Unit& unit, double value) {
  const double power = unit.exponent == 1.0 || value < 0.0 ? value : std::pow(value, unit.exponent);
  return unit.factor * power + unit.offset;
}

std::optional<Unit> find_unit(Dimension dimension, std::string_view text) {
  const std::string plain = joined(words_of(text));
  for (const NamedUnit& each : units_of(dimension)) {
    if (each.plain == plain) return each.unit;
  }
  return std::nullopt;
}

bool is_any_unit(std::string_view text) {
  return std::ranges::any_of(
      std::array{Dimension::kTime, Dimension::kSpeed, Dimension::kDirection, Dimension::kTemperature,
                 Dimension::kPressure, Dimension::kHumidity, Dimension::kRain, Dimension::kRainRate},
      [text](Dimension dimension) { return find_unit(dimension, text).has_value(); });
}

Unit base_unit(Dimension dimension) {
  const std::span<const NamedUnit> units = units_of(dimension);
  return units.empty() ? Unit{} : units.front().unit;
}

}  // namespace yuragi::daemon::tools::csv
