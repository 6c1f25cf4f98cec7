#include "daemon/tools/support/redaction.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <nlohmann/json.hpp>

#include "daemon/settings/each_value.hpp"
#include "drivers/sensor/secret_source.hpp"
#include "engine/base/json_text.hpp"
#include "engine/platform/secret_file.hpp"

namespace yuragi::daemon::tools::support {
namespace {

/// A shorter one is taken out only if it stands alone: it would tear words apart.
constexpr std::size_t kShortSecret = 4;

/// Beginnings of what names a secret, in small letters.
constexpr std::array<std::string_view, 9> kSecretWords = {"password", "passwd", "passphrase", "secret", "token",
                                                          "psk",      "pwd",    "credential", "api_key"};

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

std::string small_letters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

/// The end of the value that begins at `at`: of a quoted one its closing quotes, of another the next blank.
std::size_t end_of_value(std::string_view text, std::size_t at) {
  for (const std::string_view quotes : {"\"\"\"", "'''", "\\\"", "\"", "'"}) {
    if (!text.substr(at).starts_with(quotes)) continue;
    for (std::size_t end = at + quotes.size(); end < text.size(); ++end) {
      if (text.substr(end).starts_with(quotes)) return end + quotes.size();
      if (quotes.size() == 1 && text[end] == '\n') return end;
      if (quotes == "\"" && text[end] == '\\') ++end;
    }
    return text.size();
  }
  while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])) == 0 && text[at] != ',' &&
         text[at] != ';')
    ++at;
  return at;
}

/// Where the value begins that the word at `at` names; npos if it names none, or the place of one.
std::size_t value_named_at(std::string_view text, std::size_t at) {
  std::size_t begin = at;
  while (begin > 0 && is_word(text[begin - 1])) --begin;
  std::size_t end = at;
  while (end < text.size() && is_word(text[end])) ++end;
  const std::string_view name = text.substr(begin, end - begin);
  if (name.ends_with("_file") || name.ends_with("_env")) return std::string_view::npos;
  const auto skip = [&](std::string_view characters) {
    while (end < text.size() && characters.find(text[end]) != std::string_view::npos) ++end;
  };
  skip("\"'\\ \t");  // a key may stand in quotes
  if (end >= text.size() || (text[end] != '=' && text[end] != ':')) return std::string_view::npos;
  ++end;
  skip(" \t");
  return end < text.size() && text[end] != '\n' ? end : std::string_view::npos;
}

std::string without_named_secrets(const std::string& text) {
  const std::string small = small_letters(text);
  std::string result;
  std::size_t done = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto begins = [&](std::string_view word) { return small.compare(at, word.size(), word) == 0; };
    if (std::ranges::none_of(kSecretWords, begins)) continue;
    const std::size_t value = value_named_at(text, at);
    if (value == std::string::npos) continue;
    result += text.substr(done, value - done);
    done = end_of_value(text, value);
    const std::string_view held = std::string_view(text).substr(value, done - value);
    const bool is_empty = held == "\"\"" || held == "''" || held == "null";
    result += is_empty ? std::string(held) : '"' + std::string(Secret::kWithheld) + '"';
    at = done > at ? done - 1 : at;
  }
  return result + text.substr(std::min(done, text.size()));
}

std::string without_credentials_in_urls(std::string text) {
  constexpr std::string_view kMark = "://";
  for (std::size_t at = text.find(kMark); at != std::string::npos; at = text.find(kMark, at + 1)) {
    const std::size_t begin = at + kMark.size();
    const std::size_t end = text.find_first_of(" \t\n/\"'<>", begin);
    const std::size_t sign = text.substr(0, end).rfind('@');
    if (sign == std::string::npos || sign < begin) continue;
    text.replace(begin, sign - begin, Secret::kWithheld);
  }
  return text;
}

void replace_all(std::string& text, const std::string& secret) {
  for (std::size_t at = text.find(secret); at != std::string::npos; at = text.find(secret, at)) {
    const std::size_t end = at + secret.size();
    const bool stands_alone = (at == 0 || !is_word(text[at - 1])) && (end >= text.size() || !is_word(text[end]));
    if (secret.size() < kShortSecret && !stands_alone) {
      at = end;
      continue;
    }
    text.replace(at, secret.size(), Secret::kWithheld);
    at += Secret::kWithheld.size();
  }
}

}  // namespace

std::vector<std::string> known_secrets(const settings::Config& config) {
  std::vector<std::string> secrets;
  const auto add = [&](const Result<Secret, Failure>& secret) {
    if (secret) secrets.push_back(secret->reveal());
  };
  settings::for_each_value(config, [&](const std::string&, const Parameter& parameter, const ParameterValue& value) {
    const auto* secret = std::get_if<Secret>(&value);
    const auto* text = std::get_if<std::string>(&value);
    if (secret != nullptr && !secret->is_empty()) secrets.push_back(secret->reveal());
    if (text == nullptr || text->empty()) return;
    if (parameter.is_secret_file) add(platform::secret_in_file(*text));
    if (parameter.name.ends_with("_env")) add(drivers::sensor::secret_in_environment(*text));
  });
  return secrets;
}

Redaction::Redaction(const std::vector<std::string>& secrets) {
  for (const std::string& secret : secrets) {
    if (secret.empty() || secret == Secret::kWithheld) continue;
    secrets_.push_back(secret);
    const std::string quoted = json_text(nlohmann::json(secret));
    if (const std::string escaped = quoted.substr(1, quoted.size() - 2); escaped != secret) secrets_.push_back(escaped);
  }
  // One that holds another goes first, or its rest would stay.
  std::ranges::sort(secrets_, std::greater<>(), &std::string::size);
}

std::string Redaction::apply(std::string text) const {
  for (const std::string& secret : secrets_) replace_all(text, secret);
  return without_credentials_in_urls(without_named_secrets(text));
}

}  // namespace yuragi::daemon::tools::support
