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
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kWrittenOut = {{{"\xC3\xA4", "ae"},
                                                                                        {"\xC3\xB6", "oe"},
                                                                                        {"\xC3\xBC", "ue"},
                                                                                        {"\xC3\x84", "Ae"},
                                                                                        {"\xC3\x96", "Oe"},
                                                                                        {"\xC3\x9C", "Ue"},
                                                                                        {"\xC3\x9F", "ss"},
                                                                                        {"\xC3\xA9", "e"},
                                                                                        {"\xE2\x84\x83", " C"},
                                                                                        {"\xE2\x84\x89", " F"},
                                                                                        {"%", " percent"},
                                                                                        {"\xC2\xB0", " "}}};

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
