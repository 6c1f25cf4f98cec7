#include "daemon/web/known_host.hpp"

#include <algorithm>

#include <boost/asio/ip/address.hpp>

namespace yuragi::daemon::web {
namespace {

/// Without its port; an IPv6 address without its brackets.
std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? std::string_view() : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

bool is_equal_name(std::string_view one, std::string_view other) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(one, other, {}, lower, lower);
}

}  // namespace

bool is_known_host(std::string_view host, std::span<const std::string> names) {
  constexpr std::string_view kLocal = ".local";
  std::string_view name = without_port(host);
  boost::system::error_code error;
  boost::asio::ip::make_address(std::string(name), error);
  if (!error || is_equal_name(name, "localhost")) return true;
  if (name.size() > kLocal.size() && is_equal_name(name.substr(name.size() - kLocal.size()), kLocal))
    name.remove_suffix(kLocal.size());
  return std::ranges::any_of(names, [&](const std::string& known) {
    return is_equal_name(name, known) || is_equal_name(std::string(name) + std::string(kLocal), known);
  });
}

bool is_same_origin(std::string_view origin, std::string_view host) {
  if (origin.empty()) return true;
  const std::size_t scheme = origin.find("://");
  return scheme != std::string_view::npos && is_equal_name(origin.substr(scheme + 3), host);
}

}  // namespace yuragi::daemon::web
