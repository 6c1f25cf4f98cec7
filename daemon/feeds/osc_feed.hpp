#pragma once

#include <memory>

#include "daemon/feeds/feed.hpp"
#include "daemon/settings/feeds/osc.hpp"

namespace yuragi::daemon::feeds {

/// Sends an [[osc]]: Open Sound Control messages by UDP, with arguments of the types f and s alone.
///
///   /wind ff speed direction; /wind/NAME f for each Quantity; /wind/state s
///   /sensor/NAME/speed f, /direction f, /age f, /state s: ten times a second
///   /place/NAME ff speed direction; /place/NAME/QUANTITY f
///   /scene/NAME/opacity f, when it changes
///   [[osc.map]] f and [[osc.cue]] without arguments, at the receiver's own addresses
///
/// States also come each second. Bundles fit a datagram that no network cuts; longer ones are divided.
std::unique_ptr<Feed> make_osc_feed(const settings::feeds::Osc& config);

}  // namespace yuragi::daemon::feeds
