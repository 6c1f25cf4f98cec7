#include "daemon/settings/http_config.hpp"

#include <sstream>

#include <arpa/inet.h>

#include "engine/base/address.hpp"

namespace yuragi::daemon::settings {

Result<HttpConfig, ParameterError> http_config_of(const ParameterValues& values) {
  HttpConfig config{.listen = values.text("listen"),
                    .hosts = {},
                    .token_file = values.text("token_file"),
                    .reading_takes_token = values.text("readers") == "token",
                    .proxies = {}};
  if (config.reading_takes_token && config.token_file.empty())
    return ParameterError{"readers", "\"token\" takes a token_file; `yuragi token --new` makes one"};
  if (!config.listen.empty()) {
    if (const auto address = parse_address(config.listen); !address)
      return ParameterError{"listen", address.error().message};
  }
  std::istringstream names(values.text("hosts"));
  for (std::string name; names >> name;) {
    if (name.find_first_of("/:,") != std::string::npos)
      return ParameterError{"hosts", "\"" + name +
                                         "\" is no name; allowed: names with blanks between them, such as "
                                         "\"wall.example.org wall\""};
    config.hosts.push_back(name);
  }
  std::istringstream proxies(values.text("proxies"));
  for (std::string address; proxies >> address;) {
    in6_addr parsed{};
    if (inet_pton(AF_INET, address.c_str(), &parsed) != 1 && inet_pton(AF_INET6, address.c_str(), &parsed) != 1)
      return ParameterError{"proxies", "\"" + address +
                                           "\" is no address; allowed: addresses with blanks between them, such as "
                                           "\"127.0.0.1 ::1\""};
    config.proxies.push_back(address);
  }
  return config;
}

}  // namespace yuragi::daemon::settings
