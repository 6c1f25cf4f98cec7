#pragma once

#include <memory>

#include "daemon/feeds/feed.hpp"
#include "daemon/settings/feeds/osc.hpp"

namespace yuragi::daemon::feeds {

/// Sends an [[osc]]: Open Sound Control messages by UDP, with arguments of the types f and s alone.
///
/// The addresses of osc_addresses_of(), behind the prefix: sensors ten times a second, states and opacities when they
/// change and each second, the others each tick; then [[osc.map]] f and [[osc.cue]] without arguments at the receiver's
/// own addresses. Bundles fit a datagram that no network cuts; longer ones are divided.
std::unique_ptr<Feed> make_osc_feed(const settings::feeds::Osc& config);

}  // namespace yuragi::daemon::feeds
