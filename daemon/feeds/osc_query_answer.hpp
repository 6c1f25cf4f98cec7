#pragma once

#include <span>
#include <string>
#include <string_view>

#include "daemon/feeds/osc_addresses.hpp"
#include "daemon/http/server.hpp"
#include "daemon/values/moment.hpp"

namespace yuragi::daemon::feeds {

/// Answers `GET path?query` (Vidvox, "OSC Query Proposal", 2018): a node with all below it, one attribute of it, or
/// HOST_INFO. 404: there is no such node; 204: it has no such attribute; 400: nobody has. A number that is not there
/// has no VALUE. Nothing can be written: there is no OSC_PORT. `name`: of the server. Pure.
http::Response osc_query_answer(std::string_view path, std::string_view query, const std::string& name,
                                std::span<const OscAddress> addresses, const values::Moment& moment, values::Wind wind);

}  // namespace yuragi::daemon::feeds
