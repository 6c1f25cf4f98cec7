#include "engine/base/known_host.hpp"

#include <algorithm>

namespace yuragi {
namespace {

constexpr std::string_view kDigits = "0123456789";

bool consists_of(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

bool is_equal_name(std::string_view one, std::string_view other) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(one, other, {}, lower, lower);
}

/// Removes ":7480" from the end; only if it directly follows the host.
std::string_view without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const bool has_port = colon != std::string_view::npos && consists_of(host.substr(colon + 1), kDigits);
  return has_port ? host.substr(0, colon) : host;
}

/// No DNS name consists of digits and points only, and none has brackets.
bool is_address(std::string_view host) {
  if (host.starts_with('[') && host.ends_with(']'))
    return consists_of(host.substr(1, host.size() - 2), "0123456789abcdefABCDEF:.");
  return consists_of(host, "0123456789.") && host.find('.') != std::string_view::npos;
}

}  // namespace

bool is_known_host(std::string_view host, std::span<const std::string> names) {
  constexpr std::string_view kLocal = ".local";
  std::string_view name = without_port(host);
  if (is_address(name) || is_equal_name(name, "localhost")) return true;
  if (name.size() > kLocal.size() && is_equal_name(name.substr(name.size() - kLocal.size()), kLocal))
    name.remove_suffix(kLocal.size());
  return std::ranges::any_of(names, [&](const std::string& known) {
    return is_equal_name(name, known) || is_equal_name(std::string(name) + std::string(kLocal), known);
  });
}

bool is_same_origin(std::string_view origin, std::string_view host, bool is_https) {
  if (origin.empty()) return true;
  if (is_https && !origin.starts_with("https://")) return false;
  const std::size_t scheme = origin.find("://");
  return scheme != std::string_view::npos && is_equal_name(origin.substr(scheme + 3), host);
}

}  // namespace yuragi
