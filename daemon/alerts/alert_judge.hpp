#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/alerts/alert_news.hpp"
#include "daemon/alerts/alert_record.hpp"
#include "daemon/settings/alert_config.hpp"
#include "daemon/values/moment.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::alerts {

/// Decides when alerts begin and end, from the daemon's own state. The beginning of each is reported once, after it
/// has held for AlertConfig::after_s, and its end once. Pure: time is a parameter. Thread-safe: no.
class Judge {
 public:
  explicit Judge(const std::vector<settings::AlertConfig>& alerts) { change(alerts); }

  /// Replaces the alerts. One with the same name and subject continues; the end of a removed one is not reported.
  void change(const std::vector<settings::AlertConfig>& alerts);

  /// Continues alerts that were on in an earlier process. Those that are no longer configured are ignored.
  void resume(const std::vector<Active>& on, const Instant& now);

  /// Returns those that have begun and not ended.
  std::vector<Active> on() const;

  /// All alerts, in the order of the configuration.
  std::vector<values::AlertState> states() const;

  /// Longer sentences are cut.
  static constexpr std::size_t kMaxMessage_bytes = 500;

  /// Returns what has begun or ended since the last call. `frames`: how many the animation has made; nullopt: no
  /// scenes.
  std::vector<News> judge(const wire::Sensors& status, std::optional<std::uint64_t> frames, const Instant& now);

 private:
  /// What an alert is about: a sensor, the wind, the disk, the animation.
  struct Subject {
    std::string name;
    bool holds = false;
    std::string begins;  ///< the sentence, should it begin now
    std::string ends;
  };
  struct Progress {
    bool has_begun = false;
    MonoTime begun{};
    UtcTime begun_utc{};
    std::optional<MonoTime> differs_since{};  ///< since when the condition differs from what was reported
  };
  struct Alert {
    settings::AlertConfig config;
    std::map<std::string, Progress> of_subject;
  };

  /// Nullopt if it is not known now.
  std::vector<Subject> subjects_of(const settings::AlertConfig& alert, const wire::Sensors& status) const;

  std::vector<Alert> alerts_;
  std::optional<std::uint64_t> frames_;
  bool has_new_frame_ = true;
};

}  // namespace yuragi::daemon::alerts
