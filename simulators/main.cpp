#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "engine/base/version.hpp"
#include "engine/base/word_suggestion.hpp"
#include "simulators/core/command.hpp"

namespace {

// Exit codes of sysexits.h, as in the other programs.
constexpr int kExitUsage = 64;
constexpr int kExitUnavailable = 69;

int run(int argc, char** argv) {
  CLI::App app{"Simulated wind sensors, with the protocols of real ones and with faults on demand.", "yuragi-sim"};
  app.set_version_flag("--version", yuragi::with_version("yuragi-sim"));
  app.require_subcommand(1);
  for (const yuragi::simulators::core::Command* const command : yuragi::simulators::core::command_table())
    command->add(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();  // of the program that was launched (launched_program.hpp)
  } catch (const CLI::ParseError& error) {
    if (const std::string text = yuragi::unexpected_arguments_of(app); error.get_exit_code() != 0 && !text.empty()) {
      std::fprintf(stderr, "yuragi-sim: %s\nRun with --help for more information.\n", text.c_str());
      return kExitUsage;
    }
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "yuragi-sim: %s\n", error.what());
    return kExitUnavailable;
  }
}
