#include "daemon/tools/csv/csv_names.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "daemon/tools/csv/csv_units.hpp"
#include "daemon/tools/csv/csv_words.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

/// Without the serial numbers that HOBOware puts behind a unit: "Wind Speed, m/s (LGR S/N: 1, SEN S/N: 2)".
std::string_view without_serial_numbers(std::string_view name) {
  for (const std::string_view begin : {"(LGR S/N", "(S/N", "(SEN S/N"}) {
    name = name.substr(0, std::min(name.size(), name.find(begin)));
  }
  return name;
}

bool is_any_unit(std::string_view text) {
  for (const Dimension dimension :
       {Dimension::kTime, Dimension::kSpeed, Dimension::kDirection, Dimension::kTemperature, Dimension::kPressure,
        Dimension::kHumidity, Dimension::kRain, Dimension::kRainRate}) {
    if (find_unit(dimension, text)) return true;
  }
  return false;
}

/// Takes the words of a statistic off the end of a name. Campbell's: WVT and WVc are wind vectors, D1 their direction,
/// S the mean speed, SD1 the deviation.
Statistic take_statistic(std::vector<std::string>& words) {
  static constexpr std::array<std::string_view, 9> kMeans = {"avg", "average", "mean", "ave", "wvt",
                                                             "wvc", "d1",      "inst", "act"};
  static constexpr std::array<std::string_view, 4> kMaxima = {"max", "maximum", "peak", "smm"};
  static constexpr std::array<std::string_view, 9> kOthers = {"min", "minimum", "std", "stddev", "sd",
                                                              "sd1", "tmx",     "tmn", "lull"};
  Statistic statistic = Statistic::kMean;
  bool is_vector = false;
  while (words.size() > 1) {
    const std::string& last = words.back();
    const auto is_in = [&last](const auto& names) { return std::ranges::find(names, last) != names.end(); };
    if (is_in(kMaxima)) {
      statistic = Statistic::kMax;
    } else if (is_in(kOthers)) {
      statistic = Statistic::kOther;
    } else if (!is_in(kMeans) && !(is_vector && last == "s")) {
      break;
    }
    is_vector = is_vector || last == "wvt" || last == "wvc";
    words.pop_back();
  }
  return statistic;
}

void take_unit(std::vector<std::string>& words, Name& name) {
  // The longest unit at the end: m_s_1 before s_1.
  for (std::size_t count = std::min<std::size_t>(4, words.empty() ? 0 : words.size() - 1); count > 0; --count) {
    const std::span<const std::string> end = std::span(words).last(count);
    if (!is_any_unit(joined(end))) continue;
    name.unit_words.assign(end.begin(), end.end());
    words.resize(words.size() - count);
    return;
  }
}

bool is_number(std::string_view word) {
  return !word.empty() && std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

bool is_height(std::string_view word) {
  return word.size() > 1 && word.back() == 'm' && is_number(word.substr(0, word.size() - 1));
}

}  // namespace

Name parse_name(std::string_view text) {
  Name name;
  std::vector<std::string> words = words_of(without_serial_numbers(text));
  // The statistic stands before the unit or behind it: WS_ms_Avg, wind_speed_mean_m_s.
  name.statistic = take_statistic(words);
  take_unit(words, name);
  const Statistic before = take_statistic(words);
  if (name.statistic == Statistic::kMean) name.statistic = before;
  // A height is not part of the name.
  std::erase_if(words, is_height);
  name.stem = joined(words);
  return name;
}

}  // namespace yuragi::daemon::tools::csv
