// `yuragi hand`: sets the wind, the blackout or the camera of a running daemon by hand, for a time.
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "daemon/commands/ask_daemon.hpp"
#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/run_options.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr double kUsualWind_s = 60.0;
constexpr double kUsualHold_s = 3600.0;

struct HandOptions {
  std::string connect = fmt::format("127.0.0.1:{}", wire::kDefaultPort);
  wire::HandCommand command = {};
  double for_s = kUsualHold_s;
  bool is_without_end = false;
};

void set_by_hand(const HandOptions& options) {
  wire::HandCommand command = options.command;
  if (std::isnan(command.speed_m_s) || std::isnan(command.direction_deg) || std::isnan(options.for_s)) {
    throw ExitError(kExitUsage, "\"nan\" is not a number");  // no range refuses it
  }
  if (!options.is_without_end) command.for_s = options.for_s;
  const wire::ControlReply reply = send_control(options.connect, "hand", {.scene = "", .hand = command});
  if (!reply.by_hand) {
    throw ExitError(kExitUnavailable, "the daemon at " + options.connect +
                                          " has no scenes, or is of an older version: nothing can be set by hand");
  }
  if (!reply.done) {
    const bool is_allowed = reply.message.find("[stream] control") == std::string::npos;
    throw ExitError(is_allowed ? kExitUsage : kExitNoPermission, reply.message);
  }
  fmt::print("{}\n", reply.message);
}

using HandOptionsPointer = std::shared_ptr<HandOptions>;

std::pair<CLI::App*, HandOptionsPointer> add_part(CLI::App& hand, const char* name, const char* help,
                                                  wire::HandPart part) {
  auto options = std::make_shared<HandOptions>();
  options->command.part = part;
  CLI::App* command = hand.add_subcommand(name, help);
  command->add_option("--connect", options->connect, "where the daemon listens")->type_name("HOST:PORT");
  command->callback([options] { set_by_hand(*options); });
  return {command, options};
}

CLI::Option* add_time(CLI::App& command, HandOptions& options, double usual_s, double most_s, const char* help) {
  options.for_s = usual_s;
  return command.add_option("--for", options.for_s, help)
      ->type_name("TIME")
      ->transform(duration_in_seconds())
      ->check(CLI::Range(1.0, most_s));
}

void add_hold(CLI::App& command, HandOptions& options) {
  CLI::Option* time = add_time(command, options, kUsualHold_s, wire::kMaxHandHold_s,
                               "how long: 90 (seconds), 10min, 2h; 1 s to 24 h (default 1 h)");
  command.add_flag("--until-released", options.is_without_end, "until somebody ends it")->excludes(time);
}

void add_release(CLI::App& hand) {
  CLI::App* release = hand.add_subcommand("release", "end what is set by hand, now");
  release->require_subcommand(1);
  const auto add = [release](const char* name, const char* help, wire::HandPart part) {
    add_part(*release, name, help, part).second->command.is_release = true;
  };
  add("wind", "the scenes get the real wind again", wire::HandPart::kWind);
  add("blackout", "the walls are lit again", wire::HandPart::kBlackout);
  add("camera", "the camera is that of the time of day again", wire::HandPart::kCamera);
}

void add_hand(CLI::App& app) {
  CLI::App* hand = app.add_subcommand("hand", "set wind, blackout or camera of a running daemon by hand, for a time");
  hand->require_subcommand(1);
  hand->footer(
      "  yuragi hand wind 8 270 --for 60          8 m/s from the west for a minute, for the scenes alone\n"
      "  yuragi hand blackout --for 2h            the walls go dark now (viewers with --dark-when-closed)\n"
      "  yuragi hand camera gate                  all viewers show this camera\n"
      "  yuragi hand release wind                 end it now; `yuragi status` shows what is set\n"
      "It ends by itself, also when the daemon is started again. Recordings and what is measured stay as they are.\n"
      "Exit code 0: done; 64: a mistake in a value, or no such camera; 69: no daemon replies; 77: the daemon does not\n"
      "allow it from here (see `yuragi describe`, [stream] control).");

  const auto [wind, wind_options] = add_part(*hand, "wind", "the wind of the scenes", wire::HandPart::kWind);
  wind->add_option("speed", wind_options->command.speed_m_s, "its mean in m/s, 0 to 60")
      ->required()
      ->check(CLI::Range(0.0, wire::kMaxHandWind_m_s));
  wind->add_option("direction", wind_options->command.direction_deg, "where it comes from: 0 north, 90 east")
      ->required()
      ->check(CLI::Range(0.0, 360.0));
  add_time(*wind, *wind_options, kUsualWind_s, wire::kMaxHandWind_s,
           "how long: 90 (seconds), 10min; 1 s to 1 h (default 60 s)");

  const auto [blackout, blackout_options] =
      add_part(*hand, "blackout", "the walls go dark, as outside of opening hours", wire::HandPart::kBlackout);
  add_hold(*blackout, *blackout_options);

  const auto [camera, camera_options] = add_part(
      *hand, "camera", "all viewers show this camera, in place of that of the time of day", wire::HandPart::kCamera);
  camera->add_option("camera", camera_options->command.camera, "its name in the configuration")
      ->required()
      ->type_name("NAME");
  add_hold(*camera, *camera_options);
  add_release(*hand);
}

}  // namespace

extern const Command kHandCommand;
const Command kHandCommand{add_hand};

}  // namespace yuragi::daemon::commands
