#include "daemon/follow/company.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "daemon/settings/config_error.hpp"
#include "engine/base/contain.hpp"
#include "engine/wire/lead/wind_tick.hpp"

namespace yuragi::daemon::follow {
namespace {

/// A server without a tick for this long hangs, or without so many if these take longer: the stream itself is the sign
/// of life. Longer each time in vain.
constexpr Nanoseconds kHangsAfter = std::chrono::milliseconds(500), kHangsLongest = std::chrono::seconds(8);
constexpr int kHangsTicks = 4;
/// A stand-by leads when no leader is heard for this long, or for so many ticks.
constexpr Nanoseconds kStandsInAfter = std::chrono::seconds(3);
constexpr int kStandsInTicks = 12;

Nanoseconds at_least(Nanoseconds time, int ticks, double rate_hz) {
  return std::max(time, from_seconds(ticks / rate_hz));
}

/// Two leaders on one channel take over from each other at most this often.
constexpr auto kTakesOverEvery = std::chrono::seconds(10);
/// Its own animation had to do without a tick: the others have another picture.
constexpr auto kNewEpochEvery = std::chrono::seconds(5);

std::string list_of(const std::vector<std::string>& texts) {
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace

NatsSettings link_settings(const settings::LeadConfig& config, std::string name) {
  return {.servers = config.follow.empty() ? config.lead : config.follow,
          .name = std::move(name),
          .credentials = config.credentials,
          .authorities = config.authorities};
}

void check_company(const settings::Config& config) {
  if (!config.wind.lead.is_in_company()) return;
  if (const auto refusal = NatsLink::refusal()) throw settings::ConfigError("[wind] lead, follow: " + *refusal);
}

Company::Company(const settings::Config& config, const std::string& machine, std::size_t state_bytes,
                 animation::LedSteps& steps, Instant now, std::function<void()> on_arrival, Follower::Listener listener)
    : config_(config.wind.lead),
      ticks_subject_(config_.channel + ".tick"),
      states_subject_(config_.channel + ".state"),
      questions_subject_(config_.channel + ".ask"),
      reports_subject_(config_.channel + ".node"),
      history_subject_(history_subject_of(config_.channel)),
      node_(config_.node.empty() ? machine : config_.node),
      steps_(steps),
      makeup_(makeup_of(config)),
      leader_(makeup_, config.animation.rate_hz, from_seconds(config_.delay_s), state_bytes,
              {.ticks = ticks_subject_, .states = states_subject_}, steps,
              [this](const std::string& subject, const Bytes& bytes) { link_.publish(subject, bytes); }),
      history_(node_),
      history_stream_(
          config_.channel,
          [this](const StreamRequest& request) { link_.publish(request.subject, request.bytes, link_.inbox()); }),
      follower_(
          makeup_, from_seconds(config_.delay_s), steps,
          [this](const Bytes& question) { link_.publish(questions_subject_, question, link_.inbox()); },
          std::move(listener)),
      leads_(!config_.lead.empty() && config_.follow.empty()),
      began_(now.mono),
      left_server_(now.mono),
      new_epoch_(now.mono),
      hangs_after_(at_least(kHangsAfter, kHangsTicks, config.animation.rate_hz)),
      stands_in_after_(at_least(kStandsInAfter, kStandsInTicks, config.animation.rate_hz)),
      leave_after_(hangs_after_),
      link_(link_settings(config_, makeup_.software), subjects(), std::move(on_arrival)) {
  if (leads_) lead(now);
}

Company::~Company() {
  contain("the last entries of the history", [this] {
    if (const auto message = history_.farewell()) link_.publish(history_subject_, *message);
  });
}

/// What this daemon's part takes.
std::vector<std::string> Company::subjects() const {
  std::vector<std::string> all = {ticks_subject_};
  if (!config_.follow.empty()) all.push_back(states_subject_);
  if (!config_.lead.empty()) all.insert(all.end(), {questions_subject_, reports_subject_});
  return all;
}

void Company::lead(const Instant& now) {
  leads_ = true;
  new_epoch_ = now.mono;
  const std::uint64_t latest = std::max({others_epoch_, follower_.latest_epoch(), leader_.epoch()});
  leader_.begin_epoch(now.utc, latest, std::max(follower_.newest_number(), steps_.position().number));
  follower_.leave();
  history_stream_.begin(link_.inbox(), now.mono);
}

void Company::take(const Instant& instant) {
  const MonoTime now = instant.mono;
  for (const NatsMessage& message : link_.received()) {
    if (message.subject == ticks_subject_) {
      heard_ = now;
      leave_after_ = hangs_after_;
      if (!leads_) {
        follower_.take_tick(message.bytes, now);
      } else if (const auto tick = wire::lead::decode_wind_tick(message.bytes, now);
                 tick && tick->epoch > leader_.epoch()) {
        others_epoch_ = std::max(others_epoch_, tick->epoch);
        two_leaders_ = now;
      }
    } else if (message.subject == questions_subject_) {
      if (leads_) leader_.answer(message.bytes, message.reply_to, now);
    } else if (message.subject == reports_subject_) {
      leader_.take_report(message.bytes, now);
    } else if (message.subject == history_subject_) {
      if (!leads_) continue;
      leader_.take_history(message.bytes, instant);
      history_stream_.note_message(now);
    } else if (!message.bytes.empty() && message.bytes.front() == '{') {
      take_from_jetstream(message.bytes, now);
    } else if (!leads_) {
      follower_.take_reply(message.bytes, now);
    }
  }
}

/// Other replies to the inbox do not begin with a brace.
void Company::take_from_jetstream(const std::vector<std::uint8_t>& bytes, MonoTime now) {
  const auto reply = decode_stream_reply(bytes);
  if (!reply) return;
  if (reply->kind == StreamReply::Kind::kStored) {
    history_.take_reply(reply->is_success(), now);
    hand_in_history(now);
  } else if (leads_) {
    history_stream_.take_reply(*reply, now);
  }
}

void Company::hand_in_history(MonoTime now) {
  const NatsLink::State link = link_.state();
  if (!link.is_connected) return;
  if (link.connections != connections_) history_.note_connection(now);
  connections_ = link.connections;
  if (const auto message = history_.due(now)) link_.publish(history_subject_, *message, link_.inbox());
  if (leads_) history_stream_.advance(now);
}

void Company::advance(const wind::ground::DrivingWind& wind, const Instant& now, std::uint32_t periods) {
  if (leads_) {
    keep_leading(now);
  } else if (stands_by() && now.mono - std::max(began_, follower_.heard().value_or(began_)) > stands_in_after_) {
    spdlog::info("company: no leader is heard: this daemon leads");
    lead(now);
  }
  if (leads_) {
    leader_.make_ticks(wind, now, periods);
    leader_.advance(now.mono);
  } else {
    follower_.advance(now.mono);
  }
  leave_hanging_server(now.mono);
}

/// Gives way to a leader with a later epoch, or takes over from it; and begins anew after its own animation had to do
/// without a tick.
void Company::keep_leading(const Instant& now) {
  const Nanoseconds since_epoch = now.mono - new_epoch_;
  if (others_epoch_ > leader_.epoch()) {
    if (stands_by()) {
      spdlog::info("company: another daemon leads again");
      leads_ = false;
      began_ = now.mono;
    } else if (since_epoch > kTakesOverEvery) {
      lead(now);
    }
    return;
  }
  const animation::LedSteps::Position at = steps_.position();
  if (at.epoch == leader_.epoch() && !at.is_exact && since_epoch > kNewEpochEvery) lead(now);
}

void Company::leave_hanging_server(MonoTime now) {
  if (now - std::max(left_server_, heard_.value_or(began_)) < leave_after_) return;
  left_server_ = now;
  leave_after_ = std::max(hangs_after_, std::min(2 * leave_after_, kHangsLongest));
  link_.leave_server();
}

bool Company::is_led(MonoTime now) const {
  return !leads_ && follower_.phase(now) == Follower::Phase::kSamePicture;
}

void Company::change(const settings::Config& config, const Instant& now) {
  PictureMakeup makeup = makeup_of(config);
  if (makeup.hash() == makeup_.hash()) return;
  makeup_ = std::move(makeup);
  leader_.set_makeup(makeup_);
  follower_.set_makeup(makeup_);
  if (leads_) lead(now);
}

void Company::report(NodeReport report, const Instant& now) {
  report.name = node_;
  report.software = makeup_.software;
  report.part = part(now.mono);
  const animation::LedSteps::Position at = steps_.position();
  report.tick = at.number;
  report.behind_s = at.behind_s;
  history_.add(report, now.utc);
  link_.publish(reports_subject_, encode(report));
  hand_in_history(now.mono);
}

std::string Company::trouble(const NatsLink::State& link, MonoTime now) const {
  if (!link.trouble.empty()) return link.trouble;
  if (leads_ && two_leaders_ && now - *two_leaders_ < kTakesOverEvery)
    return "another daemon leads on the channel " + config_.channel + ": give each leader a channel of its own";
  if (leads_) return {};
  switch (follower_.phase(now)) {
    case Follower::Phase::kNoLeader:
      return "no leader is heard on the channel " + config_.channel + ": its own sensors are used";
    case Follower::Phase::kSilent:
      return "the leader is silent: the own sensors are used until it is heard again";
    case Follower::Phase::kDiffers:
      return "cannot follow the leader: " + list_of(follower_.differences()) + "; its own sensors are used";
    default:
      return {};
  }
}

std::string Company::part(MonoTime now) const {
  if (leads_) return "leads";
  switch (follower_.phase(now)) {
    case Follower::Phase::kSamePicture:
      return "the same picture as its leader";
    case Follower::Phase::kSameWind:
      return "the leader's wind, another picture: " + list_of(follower_.differences());
    case Follower::Phase::kJoining:
      return "the leader's wind; its picture comes";
    default:
      return "its own wind, waits for a leader";
  }
}

Company::Status Company::status(MonoTime now) const {
  const NatsLink::State link = link_.state();
  Status status{.server = link.server,
                .channel = config_.channel,
                .part = part(now),
                .trouble = trouble(link, now),
                .messages = link.sent + link.received,
                .bytes = link.sent_bytes + link.received_bytes,
                .fleet = {},
                .nodes = {},
                .last = heard_};
  if (leads_) {
    const Leader::Counts& counts = leader_.counts();
    status.part += fmt::format("; {} questions answered, {} ticks sent again, {} states, {} nodes", counts.questions,
                               counts.repaired_ticks, counts.states, leader_.fleet().size());
    status.fleet = leader_.fleet().nodes(now);
    status.nodes = leader_.fleet().attention(node_, now);
  } else {
    const Follower::Counts& counts = follower_.counts();
    const auto delay_s = follower_.leaders_delay_s();
    if (delay_s && *delay_s != config_.delay_s)
      status.part += fmt::format("; not in step: [wind] delay is {:g} s there, {:g} s here", *delay_s, config_.delay_s);
    status.part += fmt::format("; {} ticks, {} lost and had again, {} without a tick, {} states", counts.ticks,
                               counts.repaired, steps_.position().without_tick, counts.states);
  }
  return status;
}

}  // namespace yuragi::daemon::follow
