#include "daemon/settings/feeds/feeds.hpp"

#include <algorithm>

namespace yuragi::daemon::settings::feeds {

bool Config::wants_real_places() const {
  return !places.empty() && std::ranges::any_of(osc, [](const Osc& feed) { return feed.wind == values::Wind::kReal; });
}

}  // namespace yuragi::daemon::settings::feeds
