#pragma once

#include <string>
#include <vector>

#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings {

/// [http]: where browsers, scripts and Prometheus ask.
struct HttpConfig {
  std::string listen;              ///< HOST:PORT, see parse_address(); empty: nowhere
  std::vector<std::string> hosts;  ///< further names by which this machine is called
  std::string token_file;          ///< if there is one, rights come from its token only; empty: from the address
  bool reading_takes_token = false;
  std::vector<std::string> proxies;  ///< addresses whose X-Forwarded-For is believed
  std::vector<std::string> origins;  ///< "https://editor.p5js.org": whose pages may read
  std::string folder;                ///< served at /site/; empty: none
  std::string certificate;           ///< a file, PEM; empty: HTTP in the clear
  std::string key;                   ///< of the certificate
};

const Fields<HttpConfig>& http_fields();

/// Fills it from the values of http_fields(). Returns the contradictions.
std::vector<ParameterError> fill_http(HttpConfig& http, const ParameterValues& values);

}  // namespace yuragi::daemon::settings
