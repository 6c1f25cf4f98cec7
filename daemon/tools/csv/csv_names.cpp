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

bool is_all_digits(std::string_view word) {
  return !word.empty() && std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

bool is_height(std::string_view word) {
  return word.size() > 1 && word.back() == 'm' && is_all_digits(word.substr(0, word.size() - 1));
}

/// "ws10m" is "ws" at 10 m.
void take_height_off(std::string& word) {
  if (word.size() < 3 || word.back() != 'm') return;
  const std::size_t end = word.find_last_not_of("0123456789", word.size() - 2);
  if (end != std::string::npos && end + 2 < word.size()) word.resize(end + 1);
}

/// What stands in brackets at the end of a name, or else behind its last comma.
std::string_view in_place_of_unit(std::string_view name) {
  name = without_blanks(name);
  if (name.ends_with(')') || name.ends_with(']')) {
    const auto open = name.find_last_of("([");
    return open == std::string_view::npos ? std::string_view() : name.substr(open + 1, name.size() - open - 2);
  }
  const auto comma = name.rfind(',');
  return comma == std::string_view::npos ? std::string_view() : without_blanks(name.substr(comma + 1));
}

/// The statistic that words in brackets name: "(10 min max)", in which "min" is of minutes.
Statistic statistic_in(std::string_view remark) {
  std::vector<std::string> words = words_of(remark);
  if (std::ranges::find(words, "gust") != words.end()) return Statistic::kMax;
  if (words.size() > 1 && is_all_digits(words[0])) words.erase(words.begin(), words.begin() + 2);
  words.insert(words.begin(), "");
  return take_statistic(words);
}

/// Returns true for what describes a column, and is no unit: "10 min avg", "true", "10m".
bool is_remark(std::string_view text) {
  static constexpr auto kRemarks = std::to_array<std::string_view>(
      {"avg",       "average", "mean",   "max",     "maximum", "gust",       "peak", "inst",     "instant",
       "min",       "mins",    "minute", "minutes", "h",       "hr",         "hour", "hours",    "m",
       "agl",       "vector",  "scalar", "true",    "tn",      "t",          "mag",  "magnetic", "north",
       "from",      "of",      "at",     "height",  "sensor",  "anemometer", "mast", "raw",      "horizontal",
       "resultant", "wvt",     "wvc",    "smp",     "std",     "sec",        "s"});
  const std::vector<std::string> words = words_of(text);
  return std::ranges::all_of(words, [](const std::string& word) {
    return is_all_digits(word) || is_height(word) || std::ranges::find(kRemarks, word) != kRemarks.end();
  });
}

}  // namespace

Name parse_name(std::string_view text) {
  text = without_serial_numbers(text);
  const std::string_view remark = in_place_of_unit(text);
  if (!remark.empty() && !is_any_unit(remark)) {
    Name name = parse_name(text.substr(0, static_cast<std::size_t>(remark.data() - text.data()) - 1));
    if (name.statistic == Statistic::kMean) name.statistic = statistic_in(remark);
    if (name.unit_words.empty() && name.unknown_unit.empty() && !is_remark(remark)) name.unknown_unit = remark;
    return name;
  }

  Name name;
  std::vector<std::string> words = words_of(text);
  // The statistic stands before the unit or behind it: WS_ms_Avg, wind_speed_mean_m_s.
  name.statistic = take_statistic(words);
  take_unit(words, name);
  const Statistic before = take_statistic(words);
  if (name.statistic == Statistic::kMean) name.statistic = before;
  // A height is not part of the name: "50m", "50 m".
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (words[i + 1] != "m" || !is_all_digits(words[i])) continue;
    words[i] += words[i + 1];
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
  std::erase_if(words, is_height);
  std::ranges::for_each(words, take_height_off);
  name.stem = joined(words);
  return name;
}

}  // namespace yuragi::daemon::tools::csv
