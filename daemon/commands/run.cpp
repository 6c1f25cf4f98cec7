// `yuragi run` and `yuragi record`: the daemon, with and without scenes.
#include <memory>

#include "daemon/commands/command.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/service/service.hpp"

namespace yuragi {
namespace {

void add_run(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("run", "the daemon: reads the wind, moves the scenes, streams them to viewers");
  command->footer(
      "Needs nothing: without --config it makes up a wind and moves a meadow. Then, in another terminal:\n"
      "  yuragi-viewer                see it\n"
      "  yuragi sensors watch         see what the sensors say\n"
      "  yuragi describe              every key that a configuration may hold");
  auto options = std::make_shared<RunOptions>();
  auto record = std::make_shared<std::optional<std::filesystem::path>>();
  options->add_to(*command);
  command->add_option("--record", *record, "write every reading into this recording as well")
      ->type_name("FILE.windlog");
  command->callback([options, record] {
    options->set_up_log();
    Service(options->config(), {.record = *record, .duration_s = options->duration_s}).run();
  });
}

void add_record(CLI::App& app) {
  CLI::App* command = app.add_subcommand("record", "write what the sensors say into a recording; no scenes");
  command->footer(
      "A recording that exists is continued. Stop it with Ctrl-C; a crash loses at most the last second.\n"
      "  yuragi record storm.windlog --config roof.toml\n"
      "  yuragi replay storm.windlog --rate 4");
  auto options = std::make_shared<RunOptions>();
  auto file = std::make_shared<std::filesystem::path>();
  command->add_option("file", *file, "the recording")->required()->type_name("FILE.windlog");
  options->add_to(*command);
  command->callback([options, file] {
    options->set_up_log();
    Service(options->config(), {.record = *file, .duration_s = options->duration_s, .with_scenes = false}).run();
  });
}

}  // namespace

extern const Command kRunCommand;
const Command kRunCommand{add_run};

extern const Command kRecordCommand;
const Command kRecordCommand{add_record};

}  // namespace yuragi
