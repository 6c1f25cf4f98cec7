#include "daemon/commands/parameter_commands.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/commands/ask_daemon.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/settings/config_edit.hpp"
#include "daemon/state/parameter_json.hpp"

namespace yuragi::daemon::commands {
namespace {

/// New scenes must be made first, and wait for those that still fade.
constexpr auto kParameterTimeout = std::chrono::seconds(60);

struct ParameterOptions {
  bool of_scenes = false;
  std::string connect = fmt::format("127.0.0.1:{}", wire::kDefaultPort);
  std::string scene;               ///< empty: [look], or every scene
  std::vector<std::string> words;  ///< KEY=VALUE, or KEY
  bool as_toml = false;
  bool as_json = false;
};

/// Sends the command and returns the reply to it.
wire::ControlReply carry_out(const ParameterOptions& options, wire::ParameterCommand command) {
  const wire::Control control{.scene = "", .parameters = std::move(command)};
  if (control.parameters->edits.size() > wire::kMaxParameterEdits ||
      wire::encode(control).size() > wire::kMaxClientMessageBytes) {
    throw ExitError(kExitUsage, "too many values at once: set them with several commands");
  }
  auto reply = send_control(options.connect, options.of_scenes ? "scene" : "look", control, kParameterTimeout);
  if (!reply.parameters) {
    throw ExitError(kExitUnavailable, "the daemon at " + options.connect +
                                          " is of an older version, which cannot list or set values while it runs");
  }
  if (!reply.done) {
    throw ExitError(reply.parameters->refusal.empty() ? kExitUsage : kExitNoPermission, reply.message);
  }
  return reply;
}

/// The parts of the daemon's list to which the options refer.
std::vector<wire::ParameterGroup> groups_for(const ParameterOptions& options) {
  auto groups = carry_out(options, {.describe = true}).parameters->groups;
  std::string known;
  for (const wire::ParameterGroup& group : groups) {
    if (!group.scene.empty()) known.append(known.empty() ? "" : ", ").append(group.scene);
  }
  std::erase_if(groups, [&](const wire::ParameterGroup& group) {
    if (!options.scene.empty()) return group.scene != options.scene;
    return group.scene.empty() == options.of_scenes;
  });
  if (groups.empty() && !options.scene.empty()) {
    throw ExitError(kExitUsage, fmt::format("there is no scene \"{}\"; there are: {}", options.scene, known));
  }
  return groups;
}

void change(const ParameterOptions& options, std::vector<wire::ParameterEdit> edits) {
  fmt::print("{}\n", carry_out(options, {.scene = options.scene, .edits = std::move(edits)}).message);
}

void set_values(const ParameterOptions& options) {
  std::vector<wire::ParameterEdit> edits;
  for (const std::string& word : options.words) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ExitError(kExitUsage, fmt::format("\"{}\" is not KEY=VALUE", word));
    }
    edits.push_back({word.substr(0, equals), word.substr(equals + 1)});
  }
  change(options, std::move(edits));
}

void reset_values(const ParameterOptions& options) {
  std::vector<wire::ParameterEdit> edits;
  for (const std::string& key : options.words) edits.push_back({key, std::nullopt});
  if (edits.empty()) {
    const std::vector<wire::ParameterGroup> groups = groups_for(options);
    for (const wire::ParameterState& state : groups.front().parameters) {
      if (state.value != state.configured) edits.push_back({state.name, std::nullopt});
    }
  }
  if (edits.empty()) {
    fmt::print("nothing has changed: all values are those of the configuration\n");
    return;
  }
  change(options, std::move(edits));
}

/// As written in the configuration.
std::string toml_text(const wire::ParameterState& state, const std::string& value) {
  return state.kind == wire::ParameterKind::kText ? settings::toml_value(value) : value;
}

/// Prints the lines that the configuration needs for the present values.
void print_toml(const wire::ParameterGroup& group) {
  const bool is_changed =
      std::ranges::any_of(group.parameters, [](const auto& state) { return state.value != state.configured; });
  if (!is_changed) return;
  if (group.scene.empty()) {
    fmt::print("# in [look], in place of lines with the same keys:\n");
  } else {
    fmt::print("# in the [[scene]] {}, of the kind {}, in place of lines with the same keys:\n",
               settings::toml_value(group.scene), settings::toml_value(group.kind));
  }
  for (const wire::ParameterState& state : group.parameters) {
    if (state.value == state.configured) continue;
    if (state.value) {
      fmt::print("{} = {}\n", state.name, toml_text(state, *state.value));
    } else {
      fmt::print("# without a line for {}\n", state.name);
    }
  }
}

void print_table(const wire::ParameterGroup& group) {
  if (!group.scene.empty()) fmt::print("{} ({})\n", group.scene, group.kind);
  for (const wire::ParameterState& state : group.parameters) {
    const auto shown = [&state](const std::optional<std::string>& value) {
      if (!value) return "left out: " + state.left_out;
      return toml_text(state, *value) + (state.unit.empty() ? "" : " " + state.unit);
    };
    std::string line = fmt::format("  {:<20} {}", state.name, shown(state.value));
    if (state.value != state.configured) line += fmt::format("  (the configuration: {})", shown(state.configured));
    if (state.change == KeyChange::kTakesRestart) line += "  (needs a restart)";
    fmt::print("{}\n", line);
  }
}

void list_values(const ParameterOptions& options) {
  const std::vector<wire::ParameterGroup> groups = groups_for(options);
  if (options.as_json) return print_json(state::parameters_json(groups));
  for (const wire::ParameterGroup& group : groups) options.as_toml ? print_toml(group) : print_table(group);
}

}  // namespace

void add_parameter_commands(CLI::App& command, bool of_scenes) {
  const std::string what = of_scenes ? "a scene" : "the look";
  const auto add = [&](const char* name, const std::string& help) {
    auto options = std::make_shared<ParameterOptions>();
    options->of_scenes = of_scenes;
    CLI::App* added = command.add_subcommand(name, help);
    added->add_option("--connect", options->connect, "where the daemon listens")->type_name("HOST:PORT");
    return std::pair(added, options);
  };
  const auto add_scene = [&](CLI::App& added, ParameterOptions& options) {
    if (!of_scenes) return static_cast<CLI::Option*>(nullptr);
    return added.add_option("scene", options.scene, "name of the scene in the configuration")->type_name("NAME");
  };

  const auto [values, listed] =
      add("values", "list the values of " + (of_scenes ? "the scenes" : what) + " as they are now");
  add_scene(*values, *listed);
  auto* const toml = values->add_flag("--toml", listed->as_toml,
                                      "only those that differ from the configuration, as lines to be pasted there");
  add_json(*values, listed->as_json);
  values->get_option("--json")->excludes(toml);
  values->footer(
      "--json: a list with scene, kind and parameters: a list with name, value, configured (the configuration's), "
      "default\n(null: left out), unit, kind, min, max, choices, left_out, change and help for each.");
  values->callback([options = listed] { list_values(*options); });

  const auto [set, changed] = add("set", "set values of " + what + " while the daemon runs");
  if (CLI::Option* scene = add_scene(*set, *changed)) scene->required();
  set->add_option("values", changed->words, "a key of the configuration and its value")
      ->type_name("KEY=VALUE")
      ->required();
  set->footer(of_scenes
                  ? "  yuragi scene set elm gain=1.4            one value, at once\n"
                    "  yuragi scene set elm x=2 z=-3            the scene is made anew, and cross-faded to in 2 s\n"
                    "  yuragi scene values --toml               what to write into the configuration to keep them\n"
                    "Keys, units and limits are those of [[scene]] (see `yuragi describe`). Values last until the\n"
                    "configuration is read again (`yuragi reload`) or the daemon is started again."
                  : "  yuragi look set haze=0.4 clouds=1        the viewers cross-fade to it\n"
                    "  yuragi look set time=06:30               early in the morning\n"
                    "  yuragi look values --toml                what to write into the configuration to keep them\n"
                    "Keys, units and limits are those of [look] (see `yuragi describe`). Values last until the\n"
                    "configuration is read again (`yuragi reload`) or the daemon is started again.");
  set->callback([options = changed] { set_values(*options); });

  const auto [reset, undone] = add("reset", "set values of " + what + " back to those of the configuration");
  if (CLI::Option* scene = add_scene(*reset, *undone)) scene->required();
  reset->add_option("keys", undone->words, "which; without any: all that differ")->type_name("KEY");
  reset->callback([options = undone] { reset_values(*options); });
}

}  // namespace yuragi::daemon::commands
