#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/alerts/alert_judge.hpp"
#include "daemon/alerts/alert_ledger.hpp"
#include "daemon/alerts/delivery_queue.hpp"
#include "daemon/settings/alert_config.hpp"
#include "daemon/values/moment.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::alerts {

/// The [[alert]]s of an installation: their beginning and end are logged, and reported by commands and webhooks, each
/// on its own thread. Thread-safe: no.
class Alerts {
 public:
  /// `host`: the name of this machine in messages. `record_file`: the file of Ledger, from which alerts
  /// continue; empty: they start again.
  Alerts(const std::vector<settings::AlertConfig>& alerts, std::string host, const std::filesystem::path& record_file,
         const Instant& now);
  ~Alerts();
  Alerts(const Alerts&) = delete;
  Alerts& operator=(const Alerts&) = delete;

  void change(const std::vector<settings::AlertConfig>& alerts);

  /// Call it about twice a second. Does not wait. See Judge::judge().
  void judge(const wire::Sensors& status, std::optional<std::uint64_t> frames, const Instant& now);

  /// All alerts, in the order of the configuration. One is on from its beginning to its end.
  std::vector<values::AlertState> states() const { return judge_.states(); }

 private:
  void resume(const std::vector<settings::AlertConfig>& alerts, const Instant& now);
  void push(Channel way, const News& news);

  Judge judge_;
  std::string host_;
  std::optional<Ledger> ledger_;
  std::map<std::pair<std::string, Channel>, DeliveryQueue> queues_;  ///< by the alert's name; made when needed
};

}  // namespace yuragi::daemon::alerts
