#include "drivers/json/headers_file.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "engine/platform/secret_file.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::drivers::json {
namespace {

constexpr std::size_t kMaxHeaders = 16;

/// RFC 9110, 5.6.2.
bool is_token_character(char c) {
  const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  return is_letter || std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool is_header(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == 0 || colon == std::string_view::npos) return false;
  const std::string_view value = line.substr(colon + 1);
  const bool is_visible = std::ranges::all_of(value, [](char c) { return (c >= ' ' && c <= '~') || c == '\t'; });
  return std::ranges::all_of(line.substr(0, colon), is_token_character) && is_visible &&
         value.find_first_not_of(" \t") != std::string_view::npos;
}

}  // namespace

Result<std::vector<Secret>, Failure> headers_of(std::string_view text) {
  std::vector<Secret> headers;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || line.front() == '#') continue;
    if (!is_header(line)) return Failure{fmt::format("line {} is not a header; write \"Name: value\"", number)};
    if (headers.size() == kMaxHeaders) return Failure{fmt::format("too many headers (maximum {})", kMaxHeaders)};
    headers.emplace_back(std::string(line));
  }
  return headers;
}

Result<std::vector<Secret>, Failure> headers_in_file(const std::filesystem::path& file) {
  const auto text = platform::read_whole(file, platform::kMaxSecretFile);
  if (!text) return Failure{fmt::format("\"{}\" {}", file.string(), text.error().message)};
  auto headers = headers_of(*text);
  if (!headers) return Failure{fmt::format("\"{}\": {}", file.string(), headers.error().message)};
  return headers;
}

}  // namespace yuragi::drivers::json
