#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/settings/config.hpp"
#include "engine/base/version.hpp"
#include "engine/base/word_suggestion.hpp"

int main(int argc, char** argv) {
  using namespace yuragi;
  namespace commands = daemon::commands;
  try {
    CLI::App app{
        "Yuragi: real wind moves grass, cloth, trees and flames.\nStart with `yuragi run`, which needs neither sensor "
        "nor configuration, and show the scenes with `yuragi-viewer`.",
        "yuragi"};
    app.set_version_flag("--version", with_version("yuragi"));
    app.require_subcommand(1);
    for (const commands::Command* command : commands::command_table()) command->add(app);
    try {
      app.parse(argc, argv);
      return 0;
    } catch (const CLI::ParseError& error) {
      if (const std::string text = unexpected_arguments_of(app); error.get_exit_code() != 0 && !text.empty()) {
        std::fprintf(stderr, "yuragi: %s\nRun with --help for more information.\n", text.c_str());
        return commands::kExitUsage;
      }
      return app.exit(error) == 0 ? 0 : commands::kExitUsage;
    }
  } catch (const daemon::settings::ConfigError& error) {
    std::fprintf(stderr, "%s\n", error.what());  // its lines begin with the place, as a compiler's do
    return commands::kExitConfig;
  } catch (const commands::ExitError& error) {
    if (*error.what() != '\0') std::fprintf(stderr, "yuragi: %s\n", error.what());
    return error.code();
  } catch (const FailureError& error) {
    std::fprintf(stderr, "yuragi: %s\n", error.what());
    return commands::exit_code_of(error.kind());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "yuragi: %s\n", error.what());
    return commands::kExitSoftware;
  }
}
