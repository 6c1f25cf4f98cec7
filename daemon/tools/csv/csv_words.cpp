#include "daemon/tools/csv/csv_words.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace yuragi::daemon::tools::csv {
namespace {

bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}

bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}

bool is_digit_sign(char c) {
  return c >= '0' && c <= '9';
}

/// Signs beyond ASCII that matter, in UTF-8, as they are commonly written out.
constexpr auto kWrittenOut = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"ä", "ae"},
    {"ö", "oe"},
    {"ü", "ue"},
    {"Ä", "Ae"},
    {"Ö", "Oe"},
    {"Ü", "Ue"},
    {"ß", "ss"},
    {"à", "a"},
    {"á", "a"},
    {"â", "a"},
    {"ã", "a"},
    {"ç", "c"},
    {"è", "e"},
    {"é", "e"},
    {"ê", "e"},
    {"ì", "i"},
    {"í", "i"},
    {"ñ", "n"},
    {"ò", "o"},
    {"ó", "o"},
    {"ô", "o"},
    {"õ", "o"},
    {"ù", "u"},
    {"ú", "u"},
    {"û", "u"},
    {"℃", " C"},
    {"℉", " F"},
    {"%", " percent"},
    {"°", " "},
    {"最大瞬間風速", "gust "},
    {"平均風速", "windspeed "},
    {"風速", "windspeed "},
    {"風向", "winddirection "},
    {"年月日時", "datetime "},
    {"気温", "temperature "},
    {"相対湿度", "humidity "},
    {"現地気圧", "pressure "},
    {"北", "N"},
    {"東", "E"},
    {"南", "S"},
    {"西", "W"},
});

std::string written_out(std::string_view name) {
  std::string plain;
  while (!name.empty()) {
    const auto* const found =
        std::ranges::find_if(kWrittenOut, [&](const auto& each) { return name.starts_with(each.first); });
    if (found != kWrittenOut.end()) {
      plain += found->second;
      name.remove_prefix(found->first.size());
    } else {
      plain += name.front();
      name.remove_prefix(1);
    }
  }
  return plain;
}

}  // namespace

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  char before = ' ';
  for (const char sign : written_out(name)) {
    const char c = is_upper(sign) ? static_cast<char>(sign - 'A' + 'a') : sign;
    const bool begins_word = is_upper(sign) && is_lower(before);
    if ((begins_word || !(is_lower(c) || is_digit_sign(c))) && !words.back().empty()) words.emplace_back();
    if (is_lower(c) || is_digit_sign(c)) words.back() += c;
    before = sign;
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::string joined(std::span<const std::string> words) {
  std::string all;
  for (const std::string& word : words) all += word;
  return all;
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](char c) { return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace yuragi::daemon::tools::csv
