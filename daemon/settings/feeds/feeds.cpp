#include "daemon/settings/feeds/feeds.hpp"

#include <algorithm>

namespace yuragi::daemon::settings::feeds {

bool Config::wants_real_places() const {
  const bool is_queried = !osc_query.listen.empty() && osc_query.wind == values::Wind::kReal;
  const auto sends_real = [](const Osc& feed) { return feed.wind == values::Wind::kReal; };
  return !places.empty() && (is_queried || std::ranges::any_of(osc, sends_real));
}

std::vector<values::Grid> Config::grids() const {
  std::vector<values::Grid> all;
  for (const Dmx& feed : dmx) {
    for (const DmxGrid& grid : feed.grids) {
      if (std::ranges::count(all, grid.grid) == 0) all.push_back(grid.grid);
    }
  }
  return all;
}

}  // namespace yuragi::daemon::settings::feeds
