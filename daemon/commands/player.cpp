// `yuragi player`: shows and controls the recordings that a running daemon plays.
#include <algorithm>
#include <charconv>
#include <iterator>
#include <memory>
#include <thread>

#include <fmt/core.h>

#include "daemon/commands/ask_daemon.hpp"
#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/state/sensor_json.hpp"
#include "daemon/tools/sensors/player_text.hpp"

namespace yuragi::daemon::commands {
namespace {

/// An order is carried out by the sensor's next poll, which follows at once unless its disk hangs.
constexpr auto kOrderTimeout = std::chrono::seconds(5);
constexpr auto kOrderPause = std::chrono::milliseconds(20);

struct PlayerCommandOptions {
  std::string connect = fmt::format("127.0.0.1:{}", wire::kDefaultPort);
  wire::PlayerCommand command = {};
  bool as_json = false;
};

wire::ControlReply send_command(const PlayerCommandOptions& options, const wire::PlayerCommand& command) {
  return send_control(options.connect, "player", {.scene = "", .player = command});
}

void print_states(const PlayerCommandOptions& options, const std::vector<wire::PlayerState>& players) {
  if (options.as_json) return print_json(state::players_json(players));
  for (const wire::PlayerState& player : players) fmt::print("{}", tools::sensors::player_text(player));
}

/// Waits until each player has carried out its order in `given`, and returns their states then.
std::vector<wire::PlayerState> wait_for_orders(const PlayerCommandOptions& options,
                                               const std::vector<wire::PlayerState>& given) {
  const auto deadline = std::chrono::steady_clock::now() + kOrderTimeout;
  while (true) {
    const wire::ControlReply reply = send_command(options, {.sensor = options.command.sensor});
    const bool is_done = std::ranges::equal(
        reply.players, given, [](const auto& now, const auto& then) { return now.orders_done >= then.order; });
    if (is_done) return reply.players;
    if (std::chrono::steady_clock::now() > deadline) {
      print_states(options, reply.players);
      throw ExitError(kExitUnavailable, "the request is pending: the recording cannot be read at present");
    }
    std::this_thread::sleep_for(kOrderPause);
  }
}

void print_status(const PlayerCommandOptions& options) {
  const wire::ControlReply reply = send_command(options, options.command);
  if (!reply.done) throw ExitError(reply.players.empty() ? kExitUsage : kExitNoPermission, reply.message);
  print_states(options, reply.players);
}

void give_order(const PlayerCommandOptions& options) {
  const wire::ControlReply reply = send_command(options, options.command);
  if (!reply.done) {
    const std::string message = reply.message.empty() ? "this daemon plays no recordings" : reply.message;
    throw ExitError(reply.players.empty() ? kExitUsage : kExitNoPermission, message);
  }
  const std::vector<wire::PlayerState> players = wait_for_orders(options, reply.players);
  print_states(options, players);
  std::string refusals;
  for (const wire::PlayerState& player : players) {
    if (player.refusal.empty()) continue;
    refusals += fmt::format("{}{}: {}", refusals.empty() ? "" : "\n", player.sensor, player.refusal);
  }
  if (!refusals.empty()) throw ExitError(kExitUsage, refusals);
}

using PlayerOptionsPointer = std::shared_ptr<PlayerCommandOptions>;

/// Adds `yuragi player NAME`, with the options that all of them have.
CLI::App* add_action(CLI::App& player, const char* name, const char* help, const PlayerOptionsPointer& options) {
  CLI::App* command = player.add_subcommand(name, help);
  command
      ->add_option("--sensor", options->command.sensor,
                   "this sensor only; default: every sensor that plays a recording")
      ->type_name("NAME");
  command->add_option("--connect", options->connect, "where the daemon listens")->type_name("HOST:PORT");
  add_json(*command, options->as_json);
  return command;
}

void add_player(CLI::App& app) {
  CLI::App* player = app.add_subcommand("player", "control the recordings that a running daemon plays");
  player->require_subcommand(1);
  player->footer(
      "For sensors of the driver windlog, and for `yuragi replay`:\n"
      "  yuragi player status                     position of each recording\n"
      "  yuragi player pause                      pause; the scenes keep the present wind\n"
      "  yuragi player step 10                    advance by ten readings, and pause\n"
      "  yuragi player seek 90                    to 90 s after the first reading\n"
      "  yuragi player seek +30                   30 s forward; -30: backward\n"
      "  yuragi player seek 2018-07-20T14:05:00Z  to a time (UTC if it has no zone)\n"
      "  yuragi player rate 4\n"
      "A seek fades from the old place to the new one ([[sensor]] seam), so that nothing jumps.\n"
      "--json: a list with sensor, file, is_open, position_s, length_s, recorded_utc_ns, rate, is_paused,\n"
      "is_finished, loops, rounds, refusal for each recording; null while it cannot be read.\n"
      "Exit code 0: done; 64: the sensor or place does not exist; 69: no daemon replies; 77: the daemon does not\n"
      "allow it from here (see `yuragi describe`, [stream] control).");

  const auto add = [player](const char* name, const char* help, wire::PlayerAction action) {
    auto options = std::make_shared<PlayerCommandOptions>();
    options->command.action = action;
    CLI::App* command = add_action(*player, name, help, options);
    command->callback([options] { give_order(*options); });
    return std::pair(command, options);
  };
  auto options = std::make_shared<PlayerCommandOptions>();
  add_action(*player, "status", "show the position of each recording", options)->callback([options] {
    print_status(*options);
  });
  add("pause", "pause; the scenes keep the present wind", wire::PlayerAction::kPause);
  add("resume", "go on", wire::PlayerAction::kResume);
  const auto [step, step_options] =
      add("step", "advance by a number of readings, and pause", wire::PlayerAction::kStep);
  step->add_option("count", step_options->command.count, "how many readings (default 1)")
      ->check(CLI::Range(std::uint32_t{1}, wire::kMaxSteps));
  const auto [seek, seek_options] = add("seek", "continue from another place", wire::PlayerAction::kSeek);
  seek->add_option("place", seek_options->command.place,
                   "seconds from the beginning (90), forward or backward (+30, -30), or a time (ISO 8601)")
      ->required();
  const auto [rate, rate_options] = add("rate", "play faster or slower", wire::PlayerAction::kRate);
  rate->add_option("rate", rate_options->command.rate, "seconds of the recording per second, 0.01 to 1000")
      ->required()
      ->check(CLI::Range(wire::kMinPlayRate, wire::kMaxPlayRate));
}

}  // namespace

extern const Command kPlayerCommand;
const Command kPlayerCommand{add_player};

}  // namespace yuragi::daemon::commands
