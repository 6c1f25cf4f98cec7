// CLI11 2.4 (Debian 13) refuses a command whose positional has the name of one of its options: no command of the
// program works then.
#include <memory>
#include <set>
#include <string>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "daemon/commands/command.hpp"

namespace yuragi::daemon::commands {
namespace {

void expect_distinct_names(const CLI::App& command) {
  std::set<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    names.insert(option->get_lnames().begin(), option->get_lnames().end());
    names.insert(option->get_snames().begin(), option->get_snames().end());
  }
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    EXPECT_FALSE(names.contains(option->get_name(true))) << command.get_name() << ": " << option->get_name(true);
  }
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    expect_distinct_names(*below);
  }
}

TEST(OptionNames, AreNotThoseOfPositionals) {
  CLI::App app;
  for (const Command* command : command_table()) command->add(app);
  ASSERT_GT(app.get_subcommands([](const CLI::App*) { return true; }).size(), 10U);
  expect_distinct_names(app);
}

}  // namespace
}  // namespace yuragi::daemon::commands
