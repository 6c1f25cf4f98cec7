#include "engine/base/word_suggestion.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace yuragi {
namespace {

/// The optimal string alignment distance.
std::size_t slips_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last;
  std::vector<std::size_t> last(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::vector<std::size_t> row(b.size() + 1, i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t wrong = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, wrong});
      const bool is_exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_exchanged) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = std::move(last);
    last = std::move(row);
  }
  return last[b.size()];
}

}  // namespace

std::string_view suggest_word(std::string_view word, std::span<const std::string> known) {
  std::string_view best;
  std::size_t fewest = (word.size() + 1) / 3 + 1;
  for (const std::string& candidate : known) {
    const std::size_t slips = slips_between(word, candidate);
    if (slips >= fewest) continue;
    fewest = slips;
    best = candidate;
  }
  return best;
}

std::string unexpected_arguments_text(std::span<const std::string> arguments, std::span<const std::string> known) {
  if (arguments.empty()) return "";
  std::string text = arguments.size() == 1 ? "unexpected argument: " : "unexpected arguments: ";
  std::string suggestion;
  for (const std::string& argument : arguments) {
    text += (text.ends_with(": ") ? "\"" : ", \"") + argument + "\"";
    if (suggestion.empty()) suggestion = suggest_word(argument.substr(0, argument.find('=')), known);
  }
  return suggestion.empty() ? text : text + "; did you mean \"" + suggestion + "\"?";
}

}  // namespace yuragi
