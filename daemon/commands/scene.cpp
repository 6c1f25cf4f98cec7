// `yuragi scene`: lists, shows and hides the scenes of a running daemon, and lists and sets their values.
#include <algorithm>
#include <memory>

#include <fmt/core.h>

#include "daemon/commands/ask_daemon.hpp"
#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/commands/parameter_commands.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/state/sensor_json.hpp"

namespace yuragi::daemon::commands {
namespace {

struct SceneOptions {
  std::string connect = fmt::format("127.0.0.1:{}", wire::kDefaultPort);
  wire::Control control = {};
  bool as_json = false;  ///< of the list
};

wire::ControlReply send(const SceneOptions& options) {
  return send_control(options.connect, "scene", options.control);
}

void list_scenes(const SceneOptions& options) {
  const wire::ControlReply reply = send(options);
  if (options.as_json) return print_json(state::scenes_json(reply.scenes));
  for (const wire::SceneState& scene : reply.scenes)
    fmt::print("{:<24} {:<10} {}\n", scene.name, scene.kind, scene.shown ? "shown" : "hidden");
}

void change_scene(const SceneOptions& options) {
  const wire::ControlReply reply = send(options);
  if (reply.done) {
    fmt::print("{}\n", reply.message);
    return;
  }
  const bool is_known = std::any_of(reply.scenes.begin(), reply.scenes.end(),
                                    [&](const wire::SceneState& scene) { return scene.name == options.control.scene; });
  throw ExitError(is_known ? kExitNoPermission : kExitUsage, reply.message);
}

void add_scene(CLI::App& app) {
  CLI::App* scene = app.add_subcommand("scene", "show, hide, switch and change the scenes of a running daemon");
  scene->require_subcommand(1);
  scene->footer(
      "  yuragi scene list                        all scenes, and which are shown\n"
      "  yuragi scene switch elm --fade 5         show this one and hide all others: a cross-fade\n"
      "  yuragi scene set elm gain=1.4            change a value of it\n"
      "Exit code 0: done; 64: the scene does not exist, or a mistake in a value; 69: no daemon replies; 77: the\n"
      "daemon does not allow it from here (see `yuragi describe`, [stream] control).");

  const auto add = [scene](const char* name, const char* help, bool shown, bool hide_others) {
    CLI::App* command = scene->add_subcommand(name, help);
    auto options = std::make_shared<SceneOptions>();
    options->control.shown = shown;
    options->control.hide_others = hide_others;
    command->add_option("scene", options->control.scene, "name of the scene in the configuration")
        ->required()
        ->type_name("NAME");
    command->add_option("--fade", options->control.over_s, "how long it takes: 5 (seconds), 2min; 0 to 1h (default 2)")
        ->type_name("TIME")
        ->transform(duration_in_seconds())
        ->check(CLI::Range(0.0, wire::kMaxFade_s));
    command->add_option("--connect", options->connect, "where the daemon listens")->type_name("HOST:PORT");
    command->callback([options] { change_scene(*options); });
  };
  CLI::App* list = scene->add_subcommand("list", "list all scenes, and which are shown");
  auto options = std::make_shared<SceneOptions>();
  list->add_option("--connect", options->connect, "where the daemon listens")->type_name("HOST:PORT");
  add_json(*list, options->as_json);
  list->footer("--json: a list with name, kind, is_shown (true or false) for each scene.");
  list->callback([options] { list_scenes(*options); });
  add("show", "fade a scene in", true, false);
  add("hide", "fade a scene out", false, false);
  add("switch", "fade a scene in, and all others out", true, true);
  add_parameter_commands(*scene, true);
}

}  // namespace

extern const Command kSceneCommand;
const Command kSceneCommand{add_scene};

}  // namespace yuragi::daemon::commands
