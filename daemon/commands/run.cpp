// `yuragi run` and `yuragi record`: the daemon, with and without scenes.
#include <memory>

#include "daemon/commands/command.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/service/service.hpp"

namespace yuragi::daemon::commands {
namespace {

void add_run(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("run", "run the daemon: read the wind, move the scenes, stream them to viewers");
  command->footer(
      "Without --config it uses a synthetic wind and shows a meadow. Then, in another terminal:\n"
      "  yuragi-viewer                show the scenes\n"
      "  yuragi sensors watch         show the sensors\n"
      "  yuragi describe              list every key of a configuration");
  auto options = std::make_shared<RunOptions>();
  auto record = std::make_shared<std::optional<std::filesystem::path>>();
  options->add_to(*command);
  command->add_option("--record", *record, "also write every reading to this recording")->type_name("FILE.windlog");
  command->callback([options, record] {
    options->set_up_log();
    service::Service(options->config(), {.record = *record, .duration_s = options->duration_s}).run();
  });
}

void add_record(CLI::App& app) {
  CLI::App* command = app.add_subcommand("record", "record the sensors, without scenes");
  command->footer(
      "A recording that exists is continued. Stop it with Ctrl-C; a crash loses at most half a second.\n"
      "  yuragi record storm.windlog --config roof.toml\n"
      "  yuragi replay storm.windlog --rate 4");
  auto options = std::make_shared<RunOptions>();
  auto file = std::make_shared<std::filesystem::path>();
  command->add_option("file", *file, "the recording")->required()->type_name("FILE.windlog");
  options->add_to(*command);
  command->callback([options, file] {
    options->set_up_log();
    service::Service(options->config(), {.record = *file, .duration_s = options->duration_s, .with_scenes = false})
        .run();
  });
}

}  // namespace

extern const Command kRunCommand;
const Command kRunCommand{add_run};

extern const Command kRecordCommand;
const Command kRecordCommand{add_record};

}  // namespace yuragi::daemon::commands
