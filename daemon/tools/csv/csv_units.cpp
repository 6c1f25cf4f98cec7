#include "daemon/tools/csv/csv_units.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "daemon/tools/csv/csv_words.hpp"
#include "drivers/decode/speed_units.hpp"
#include "engine/base/units.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

struct NamedUnit {
  std::string_view plain;  ///< in lower case, without punctuation
  CsvUnit unit;
};

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
    return units;
  }();
  return kUnits;
}

constexpr CsvUnit kDegrees{"degrees"};
constexpr CsvUnit kRadians{"radians", 1.0 / kRadPerDeg};
constexpr std::array kDirectionUnits = {
    NamedUnit{"deg", kDegrees},          NamedUnit{"degree", kDegrees},      NamedUnit{"degrees", kDegrees},
    NamedUnit{"degt", kDegrees},         NamedUnit{"degn", kDegrees},        NamedUnit{"degfromn", kDegrees},
    NamedUnit{"degreesnorth", kDegrees}, NamedUnit{"degreestrue", kDegrees}, NamedUnit{"rad", kRadians},
    NamedUnit{"radian", kRadians},       NamedUnit{"radians", kRadians}};

constexpr CsvUnit kCelsius{"C"};
constexpr CsvUnit kFahrenheit{"F", 5.0 / 9.0, -32.0 * 5.0 / 9.0};
constexpr CsvUnit kKelvin{"K", 1.0, -273.15};
constexpr CsvUnit kTenthsOfCelsius{"0.1 C", 0.1};
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

constexpr CsvUnit kHectopascals{"hPa"};
constexpr CsvUnit kPascals{"Pa", 0.01};
constexpr CsvUnit kKilopascals{"kPa", 10.0};
constexpr CsvUnit kInchesOfMercury{"inHg", 33.8638866667};  // of 0 degrees Celsius: NIST SP 811, appendix B.8
constexpr CsvUnit kMillimetresOfMercury{"mmHg", 1.33322387415};
constexpr CsvUnit kTenthsOfHectopascals{"0.1 hPa", 0.1};
constexpr std::array kPressureUnits = {
    NamedUnit{"hpa", kHectopascals},          NamedUnit{"mb", kHectopascals},
    NamedUnit{"mbar", kHectopascals},         NamedUnit{"pa", kPascals},
    NamedUnit{"kpa", kKilopascals},           NamedUnit{"inhg", kInchesOfMercury},
    NamedUnit{"in", kInchesOfMercury},        NamedUnit{"mmhg", kMillimetresOfMercury},
    NamedUnit{"01hpa", kTenthsOfHectopascals}};

constexpr std::array kHumidityUnits = {NamedUnit{"percent", CsvUnit{"percent"}}, NamedUnit{"pct", CsvUnit{"percent"}},
                                       NamedUnit{"rh", CsvUnit{"percent"}}};

constexpr double kMillimetresPerInch = 25.4;
constexpr std::array kRainUnits = {NamedUnit{"mm", CsvUnit{"mm"}},
                                   NamedUnit{"millimeters", CsvUnit{"mm"}},
                                   NamedUnit{"cm", CsvUnit{"cm", 10.0}},
                                   NamedUnit{"in", CsvUnit{"in", kMillimetresPerInch}},
                                   NamedUnit{"inch", CsvUnit{"in", kMillimetresPerInch}},
                                   NamedUnit{"inches", CsvUnit{"in", kMillimetresPerInch}}};
constexpr std::array kRainRateUnits = {
    NamedUnit{"mmh", CsvUnit{"mm/h"}}, NamedUnit{"mmhr", CsvUnit{"mm/h"}}, NamedUnit{"cmh", CsvUnit{"cm/h", 10.0}},
    NamedUnit{"inh", CsvUnit{"in/h", kMillimetresPerInch}}, NamedUnit{"inhr", CsvUnit{"in/h", kMillimetresPerInch}}};

constexpr std::array kTimeUnits = {NamedUnit{"ms", CsvUnit{"ms"}}, NamedUnit{"s", CsvUnit{"s"}},
                                   NamedUnit{"sec", CsvUnit{"s"}}, NamedUnit{"seconds", CsvUnit{"s"}},
                                   NamedUnit{"milliseconds", CsvUnit{"ms"}}};

std::span<const NamedUnit> units_of(CsvDimension dimension) {
  switch (dimension) {
    case CsvDimension::kTime:
      return kTimeUnits;
    case CsvDimension::kSpeed:
      return speed_units();
    case CsvDimension::kDirection:
      return kDirectionUnits;
    case CsvDimension::kTemperature:
      return kTemperatureUnits;
    case CsvDimension::kPressure:
      return kPressureUnits;
    case CsvDimension::kHumidity:
      return kHumidityUnits;
    case CsvDimension::kRain:
      return kRainUnits;
    case CsvDimension::kRainRate:
      return kRainRateUnits;
    case CsvDimension::kNone:
      break;
  }
  return {};
}

}  // namespace

std::optional<CsvUnit> find_unit(CsvDimension dimension, std::string_view text) {
  const std::string plain = joined(words_of(text));
  for (const NamedUnit& each : units_of(dimension)) {
    if (each.plain == plain) return each.unit;
  }
  return std::nullopt;
}

CsvUnit base_unit(CsvDimension dimension) {
  const std::span<const NamedUnit> units = units_of(dimension);
  return units.empty() ? CsvUnit{} : units.front().unit;
}

}  // namespace yuragi::daemon::tools::csv
