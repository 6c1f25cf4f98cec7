#include "daemon/settings/http_config.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>
#include <string_view>

#include <arpa/inet.h>

#include "daemon/settings/stream_config.hpp"

namespace yuragi::daemon::settings {
namespace {

constexpr std::array<std::string_view, 2> kReaders = {"anyone", "token"};

Result<std::string, Failure> address_or_empty(const std::string& text) {
  if (text.empty()) return {boost::system::in_place_value};
  return checked_address(text);
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

Result<std::vector<std::string>, Failure> host_names(const std::string& text) {
  std::vector<std::string> names = words_of(text);
  for (const std::string& name : names) {
    if (name.find_first_of("/:,") == std::string::npos) continue;
    return Failure{"\"" + name +
                   "\" is not a name; allowed: names separated by blanks, such as \"wall.example.org wall\""};
  }
  return names;
}

Result<std::vector<std::string>, Failure> addresses(const std::string& text) {
  std::vector<std::string> all = words_of(text);
  for (const std::string& address : all) {
    in6_addr parsed{};
    if (inet_pton(AF_INET, address.c_str(), &parsed) == 1 || inet_pton(AF_INET6, address.c_str(), &parsed) == 1)
      continue;
    return Failure{"\"" + address +
                   "\" is not an address; allowed: addresses separated by blanks, such as \"127.0.0.1 ::1\""};
  }
  return all;
}

/// As a browser sends it (A. Barth, RFC 6454, 2011, 6.1): small letters, and no slash at the end.
bool is_origin(std::string_view text) {
  const std::size_t scheme = text.find("://");
  const std::string_view host = scheme == std::string_view::npos ? std::string_view() : text.substr(scheme + 3);
  constexpr std::string_view kOther = "/?#@,*\"'\\";
  return (text.starts_with("http://") || text.starts_with("https://")) && !host.empty() &&
         host.find_first_of(kOther) == std::string_view::npos &&
         std::ranges::none_of(text, [](char letter) { return letter >= 'A' && letter <= 'Z'; });
}

Result<std::vector<std::string>, Failure> checked_origins(const std::string& text) {
  std::vector<std::string> all = words_of(text);
  for (const std::string& origin : all) {
    if (is_origin(origin)) continue;
    return Failure{"\"" + origin +
                   "\" is not an origin; allowed: origins separated by blanks, in small letters and without a path, "
                   "such as \"http://127.0.0.1:5500 https://editor.p5js.org\""};
  }
  return all;
}

}  // namespace

const Fields<HttpConfig>& http_fields() {
  static const Fields<HttpConfig> kFields{
      {{.name = "listen",
        .default_value = std::string(),
        .help = "address and port that browsers, scripts and Prometheus ask: 127.0.0.1:7480, or 0.0.0.0:7480 for "
                "other machines, too; empty: none. Who may change something: token_file and [stream] control"},
       &HttpConfig::listen,
       address_or_empty},
      {{.name = "hosts",
        .default_value = std::string(),
        .help = "names of this machine, separated by blanks, that others use besides its own name, "
                "localhost and its addresses; a request for any other is refused"},
       &HttpConfig::hosts,
       host_names},
      {{.name = "token_file",
        .default_value = std::string(),
        .help = "a file with the token, which `yuragi token --new` makes; then only clients of the page and the stream "
                "that have it, and browsers paired with `yuragi token`, can change something, from any "
                "address; empty: only this machine can. Behind a reverse proxy a token is required",
        .is_secret_file = true},
       &HttpConfig::token_file},
      {{.name = "proxies",
        .default_value = std::string(),
        .help = "addresses, separated by blanks, of reverse proxies whose X-Forwarded-For is believed: 127.0.0.1; "
                "for the log and the limit of attempts to pair"},
       &HttpConfig::proxies,
       addresses},
      {{.name = "readers",
        .default_value = std::string("anyone"),
        .help = "who may read over HTTP: anyone who reaches the port, or only those with the token; this machine "
                "always reads /healthz",
        .choices = kReaders},
       &HttpConfig::reading_takes_token,
       [](const std::string& word) { return word == kReaders[1]; }},
      {{.name = "origins",
        .default_value = std::string(),
        .help = "origins, separated by blanks, whose pages may read the API and open a WebSocket: "
                "\"https://editor.p5js.org\"; they never change anything. Pages of the daemon always may"},
       &HttpConfig::origins,
       checked_origins},
      {{.name = "folder",
        .default_value = std::string(),
        .help = "a folder with pages of your own, served at /site/; files up to 8 MiB, without those whose name begins "
                "with a dot; empty: none"},
       &HttpConfig::folder},
      {{.name = "certificate",
        .default_value = std::string(),
        .help = "a file with the certificate of this machine and those that link it to a root (PEM, fullchain.pem of "
                "certbot): the page and HTTP are served by TLS, as https://; read again at each reload and every hour; "
                "empty: in the clear"},
       &HttpConfig::certificate},
      {{.name = "key",
        .default_value = std::string(),
        .help = "a file with the private key of the certificate (PEM, without a password)",
        .is_secret_file = true},
       &HttpConfig::key},
  };
  return kFields;
}

std::vector<ParameterError> fill_http(HttpConfig& http, const ParameterValues& values) {
  http = {};
  std::vector<ParameterError> errors = http_fields().fill(http, values.all());
  if (!http.key.empty() && http.certificate.empty()) errors.push_back({"key", "needs the certificate that it is for"});
  if (http.reading_takes_token && http.token_file.empty())
    errors.push_back({"readers", "\"token\" needs a token_file; `yuragi token --new` makes one"});
  return errors;
}

}  // namespace yuragi::daemon::settings
