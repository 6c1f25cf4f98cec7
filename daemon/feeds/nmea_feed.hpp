#pragma once

#include <memory>

#include "daemon/feeds/feed.hpp"
#include "daemon/settings/feeds/nmea.hpp"

namespace yuragi::daemon::feeds {

/// Sends an [[nmea]]: MWV and MWD to one receiver by UDP, in one datagram, and to the clients of a TCP port.
std::unique_ptr<Feed> make_nmea_feed(const settings::feeds::Nmea& config);

}  // namespace yuragi::daemon::feeds
