#include "daemon/settings/http_config.hpp"

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
  };
  return kFields;
}

std::vector<ParameterError> fill_http(HttpConfig& http, const ParameterValues& values) {
  http = {};
  std::vector<ParameterError> errors = http_fields().fill(http, values.all());
  if (http.reading_takes_token && http.token_file.empty())
    errors.push_back({"readers", "\"token\" needs a token_file; `yuragi token --new` makes one"});
  return errors;
}

}  // namespace yuragi::daemon::settings
