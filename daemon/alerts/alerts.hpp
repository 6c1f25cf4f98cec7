#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/alerts/alert_judge.hpp"
#include "daemon/alerts/delivery_queue.hpp"
#include "daemon/settings/alert_config.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::alerts {

/// The [[alert]]s of an installation: what begins or ends is written into the log, and told by commands and webhooks on
/// threads of their own. Thread-safe: no.
class Alerts {
 public:
  /// `host`: the name of this machine, for who is told.
  Alerts(const std::vector<settings::AlertConfig>& alerts, std::string host);

  void change(const std::vector<settings::AlertConfig>& alerts) { judge_.change(alerts); }

  /// To be called about twice a second. Does not wait. See AlertJudge::judge().
  void judge(const wire::Sensors& status, std::optional<std::uint64_t> frames, const Instant& now);

 private:
  AlertJudge judge_;
  DeliveryQueue commands_, webhooks_;
};

}  // namespace yuragi::daemon::alerts
