#include "daemon/sensing/player_director.hpp"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "daemon/settings/control_permission.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::sensing {
namespace {

drivers::recording::PlayerOrder order_of(const wire::PlayerCommand& command) {
  switch (command.action) {
    case wire::PlayerAction::kReport:
    case wire::PlayerAction::kPause:
      break;
    case wire::PlayerAction::kResume:
      return {.kind = drivers::recording::PlayerOrder::Kind::kResume};
    case wire::PlayerAction::kStep:
      return {.kind = drivers::recording::PlayerOrder::Kind::kStep, .count = command.count};
    case wire::PlayerAction::kSeek:
      return {.kind = drivers::recording::PlayerOrder::Kind::kSeek, .place = command.place};
    case wire::PlayerAction::kRate:
      return {.kind = drivers::recording::PlayerOrder::Kind::kRate, .rate = command.rate};
  }
  return {.kind = drivers::recording::PlayerOrder::Kind::kPause};
}

/// The order in words, for the log and for a person.
std::string text_of(const wire::PlayerCommand& command) {
  switch (command.action) {
    case wire::PlayerAction::kReport:
      break;
    case wire::PlayerAction::kPause:
      return "to pause";
    case wire::PlayerAction::kResume:
      return "to resume";
    case wire::PlayerAction::kStep:
      return fmt::format("to advance by {}", count_text(command.count, "reading"));
    case wire::PlayerAction::kSeek:
      return "to seek to " + command.place;
    case wire::PlayerAction::kRate:
      return fmt::format("to play at rate {:g}", command.rate);
  }
  return "nothing";
}

}  // namespace

PlayerDirector::PlayerDirector(settings::ControlPermission allowed, std::vector<NamedPlayer> players)
    : allowed_(allowed), players_(std::move(players)) {}

wire::ControlReply PlayerDirector::handle(const wire::PlayerCommand& command, bool is_local) {
  wire::ControlReply reply;
  std::vector<const NamedPlayer*> meant;
  std::string known;
  for (const NamedPlayer& named : players_) {
    known.append(known.empty() ? "" : ", ").append(named.sensor);
    if (!command.sensor.empty() && command.sensor != named.sensor) continue;
    meant.push_back(&named);
    reply.players.push_back(state_of(named));
  }
  if (meant.empty()) {
    reply.message = players_.empty()
                        ? "no sensor of this daemon plays a recording"
                        : fmt::format("no sensor \"{}\" plays a recording; there are: {}", command.sensor, known);
    return reply;
  }
  if (command.action == wire::PlayerAction::kReport) {
    reply.done = true;
    reply.message = "nothing was changed";
    return reply;
  }
  if (const auto refusal = settings::control_refusal(allowed_, is_local, "recordings cannot be controlled")) {
    reply.message = *refusal;
    return reply;
  }

  reply.done = true;
  for (std::size_t i = 0; i < meant.size(); ++i) {
    const auto number = meant[i]->player->order(order_of(command));
    meant[i]->wake();
    reply.done = reply.done && number;
    reply.players[i].order = number.value_or(0);
    reply.message.append(i == 0 ? "" : ", ").append(meant[i]->sensor);
  }
  reply.message += reply.done ? " was asked " + text_of(command) : ": too many requests are pending; try again";
  return reply;
}

std::optional<UtcTime> PlayerDirector::recorded_clock() const {
  std::optional<drivers::windlog::PlayerPosition> newest;
  for (const NamedPlayer& named : players_) {
    const auto position = named.player->report().position;
    if (position && (!newest || position->held_for < newest->held_for)) newest = position;
  }
  if (!newest) return std::nullopt;
  return newest->recorded + newest->held_for;
}

wire::PlayerState PlayerDirector::state_of(const NamedPlayer& named) const {
  const drivers::recording::PlayerReport report = named.player->report();
  wire::PlayerState state;
  state.sensor = named.sensor;
  state.file = report.file;
  state.orders_done = report.orders_done;
  state.refusal = report.refusal;
  if (!report.position) return state;

  const drivers::windlog::PlayerPosition& position = *report.position;
  state.is_open = true;
  state.position_s = seconds(position.log_time);
  state.length_s = seconds(position.length);
  state.recorded_utc_ns = position.recorded.time_since_epoch().count();
  state.rate = position.rate;
  state.is_paused = position.is_paused;
  state.is_finished = position.is_finished;
  state.loops = position.loops;
  state.rounds = position.rounds;
  return state;
}

}  // namespace yuragi::daemon::sensing
