#pragma once

#include <deque>
#include <string>
#include <vector>

#include "daemon/feeds/dmx_levels.hpp"
#include "daemon/feeds/dmx_universe.hpp"
#include "daemon/settings/feeds/dmx.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::feeds {

/// Sends the levels of rest of a [[dmx]] after the daemon has ended without doing so: receivers hold the last level.
/// 25 packets, because receivers of E1.31 discard up to 20 whose sequence number is not above the last one (6.7.2),
/// then three that say that no more comes. The caller calls step() at the rate at which they are to be sent.
class DmxRest {
 public:
  explicit DmxRest(const settings::feeds::Dmx& config);

  /// Sends the next packet of each universe.
  void step(MonoTime now);
  /// All are sent.
  bool is_over() const noexcept;
  /// Why some could not be sent; empty: none.
  std::string trouble() const;

 private:
  std::deque<DmxUniverse> universes_;
  std::vector<DmxLevels> levels_;
};

}  // namespace yuragi::daemon::feeds
