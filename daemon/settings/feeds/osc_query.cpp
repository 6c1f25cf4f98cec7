#include "daemon/settings/feeds/osc_query.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include "engine/base/address.hpp"

namespace yuragi::daemon::settings::feeds {
namespace {

constexpr std::size_t kMaxName = 63;  // RFC 6763, 4.1.1

bool is_ip_address(const std::string& host) {
  in6_addr bytes{};
  return ::inet_pton(AF_INET, host.c_str(), &bytes) == 1 || ::inet_pton(AF_INET6, host.c_str(), &bytes) == 1;
}

Result<std::string, Failure> checked_listen(const std::string& text) {
  if (text.empty()) return {boost::system::in_place_value, text};
  const auto address = parse_address(text);
  if (!address) return address.error();
  if (is_ip_address(address->host)) return {boost::system::in_place_value, text};
  return Failure{
      fmt::format("is \"{}\"; give an IP address of this machine, or 0.0.0.0 for all of them: 0.0.0.0:7490", text)};
}

Result<std::string, Failure> checked_name(const std::string& text) {
  if (!text.empty() && text.size() <= kMaxName) return {boost::system::in_place_value, text};
  return Failure{fmt::format("has {} bytes; give a name of 1 to {}", text.size(), kMaxName)};
}

}  // namespace

const Fields<OscQuery>& osc_query_fields() {
  static const Fields<OscQuery> kFields{
      {{.name = "listen",
        .default_value = std::string(),
        .help = "ADDRESS:PORT at which programs read which OSC addresses there are, and listen to them by WebSocket: "
                "0.0.0.0:7490; empty: nowhere. Nothing can be changed there"},
       &OscQuery::listen,
       checked_listen},
      {{.name = "announce",
        .default_value = true,
        .help = "the network's programs find it, the page and OSC sensors by themselves (Avahi); not if it listens on "
                "this machine only"},
       &OscQuery::announces},
      {{.name = "name",
        .default_value = std::string("Yuragi"),
        .help = "the name by which other programs list it; another one for each daemon"},
       &OscQuery::name,
       checked_name},
      {{.name = "wind",
        .default_value = std::string(values::kWindNames[0]),
        .help = "shaped: the wind that moves the scenes; real: the measured wind",
        .choices = values::kWindNames},
       &OscQuery::wind},
  };
  return kFields;
}

std::vector<ParameterError> fill_osc_query(OscQuery& osc_query, const ParameterValues& values) {
  osc_query = {};
  return osc_query_fields().fill(osc_query, values.all());
}

}  // namespace yuragi::daemon::settings::feeds
