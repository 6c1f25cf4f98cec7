#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/animation/led_steps.hpp"
#include "daemon/follow/fleet.hpp"
#include "daemon/follow/follower.hpp"
#include "daemon/follow/history_stream.hpp"
#include "daemon/follow/leader.hpp"
#include "daemon/follow/nats_link.hpp"
#include "daemon/follow/node_history.hpp"
#include "daemon/settings/config.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::daemon::follow {

/// Throws ConfigError if the configuration leads or follows, and this build has no NATS.
void check_company(const settings::Config& config);

/// How the servers of this configuration are connected to, under this name.
NatsSettings link_settings(const settings::LeadConfig& config, std::string name);

/// A daemon's part among those that share one wind by way of NATS: it leads, it follows, or as a stand-by it follows
/// and leads while no leader is heard. Subjects, which a server's permissions can name (CHANNEL is [wind] channel):
///
///     CHANNEL.tick   from the leader to all
///     CHANNEL.state  the state of the leader's scenes, when several followers have asked for it
///     CHANNEL.ask    from followers to the leader, who replies to _INBOX.>
///     CHANNEL.node   from each daemon to those that may lead: what becomes of it (Fleet)
///     CHANNEL.history  from each daemon to JetStream: the same in entries of ten minutes (NodeHistory)
///
/// A leader that hears another one with a later epoch takes over again, but a stand-by gives way. Belongs to the I/O
/// thread; nothing here waits.
class Company {
 public:
  /// `machine`: its name, if [wind] node is empty. `state_bytes`: the size of the animation's state. `on_arrival`:
  /// called on another thread when take() has something to do. The configuration is one that check_company() has
  /// accepted.
  Company(const settings::Config& config, const std::string& machine, std::size_t state_bytes,
          animation::LedSteps& steps, Instant now, std::function<void()> on_arrival, Follower::Listener listener);

  /// Hands in the last entries of the history, without waiting for the reply.
  ~Company();
  Company(const Company&) = delete;
  Company& operator=(const Company&) = delete;

  /// Takes what has come from the network.
  void take(const Instant& now);
  /// At each step of the own wind, shaped, which takes `periods` of the animation.
  void advance(const wind::ground::DrivingWind& wind, const Instant& now, std::uint32_t periods);

  bool leads() const noexcept { return leads_; }
  /// Returns true if the poses are another daemon's: then scenes are shown and hidden there.
  bool is_led(MonoTime now) const;
  /// For a leader: with the next tick. False if too many wait.
  bool cue(const animation::SceneCue& cue) { return leader_.cue(cue); }

  /// The leader's wind; null while the own one is used. Valid until the next call.
  const wind::ground::DrivingWind* wind() const noexcept { return leads_ ? nullptr : follower_.wind(); }

  /// Its scenes are others from now on, if the configuration's are.
  void change(const settings::Config& config, const Instant& now);

  /// What becomes of this daemon, for the list of all: call it about once a second. `name` and `part` are filled in.
  void report(NodeReport report, const Instant& now);

  struct Status {
    std::string server, channel;
    std::string part;     ///< "leads", "the same picture as its leader", ...
    std::string trouble;  ///< what is wrong, and what to do; empty: nothing
    std::uint64_t messages = 0, bytes = 0;
    std::vector<Node> fleet;         ///< all nodes that were heard, if this one leads
    std::vector<std::string> nodes;  ///< what needs attention at the others
    std::optional<MonoTime> last;    ///< when a tick was sent or heard last
  };
  Status status(MonoTime now) const;

 private:
  bool stands_by() const noexcept { return !config_.lead.empty() && !config_.follow.empty(); }
  std::vector<std::string> subjects() const;
  void lead(const Instant& now);
  void take_from_jetstream(const std::vector<std::uint8_t>& bytes, MonoTime now);
  void hand_in_history(MonoTime now);
  void keep_leading(const Instant& now);
  void leave_hanging_server(MonoTime now);
  std::string trouble(const NatsLink::State& link, MonoTime now) const;
  std::string part(MonoTime now) const;

  const settings::LeadConfig config_;
  const std::string ticks_subject_, states_subject_, questions_subject_, reports_subject_, history_subject_;
  const std::string node_;
  animation::LedSteps& steps_;
  PictureMakeup makeup_;
  Leader leader_;
  NodeHistory history_;
  HistoryStream history_stream_;
  std::uint64_t connections_ = 0;  ///< of the link, when the history was handed in last
  Follower follower_;
  bool leads_;
  std::optional<MonoTime> two_leaders_;  ///< when another one with a later epoch was heard last, as a leader
  std::uint64_t others_epoch_ = 0;
  std::optional<MonoTime> heard_;  ///< any tick, also its own: the server works
  MonoTime began_, left_server_, new_epoch_;
  const Nanoseconds hangs_after_, stands_in_after_;
  Nanoseconds leave_after_;
  NatsLink link_;  ///< last: its arrivals use the others
};

}  // namespace yuragi::daemon::follow
