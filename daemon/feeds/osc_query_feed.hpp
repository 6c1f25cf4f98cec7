#pragma once

#include <memory>

#include "daemon/feeds/feed.hpp"
#include "daemon/feeds/surroundings.hpp"
#include "daemon/settings/feeds/osc_query.hpp"

namespace yuragi::daemon::feeds {

/// Serves [osc_query] (Vidvox, "OSC Query Proposal", 2018): programs read by HTTP which addresses there are, with their
/// units and ranges (osc_query_answer()), and listen to them by WebSocket (OscQuerySockets). Nothing can be set.
/// Requests are answered within send(), at most for some milliseconds a tick. An address of the network that is in use
/// is tried again.
std::unique_ptr<Feed> make_osc_query_feed(const settings::feeds::OscQuery& config, const Surroundings& around);

}  // namespace yuragi::daemon::feeds
