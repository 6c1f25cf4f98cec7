#pragma once

#include <memory>

#include "daemon/feeds/feed.hpp"
#include "daemon/settings/feeds/dmx.hpp"

namespace yuragi::daemon::feeds {

/// Sends a [[dmx]]: levels of channels and pixels, at most 44 times a second, and at least each 0.9 s. Outside of the
/// opening hours, and at the end, the levels of rest; then E1.31's "terminated" packets, and nothing
/// more. Art-Net's receivers are not looked for (ArtPoll): they are configured.
std::unique_ptr<Feed> make_dmx_feed(const settings::feeds::Dmx& config);

}  // namespace yuragi::daemon::feeds
