#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi {

/// The known word that was probably meant: the one with the fewest errors (a letter too many, missing, wrong, or two
/// neighbours exchanged: the optimal string alignment distance), if they are few for its length; else empty.
std::string_view suggest_word(std::string_view word, std::span<const std::string> known);

/// The message about unexpected arguments, in their order: 'unexpected argument: "runn"; did you mean "run"?'. Empty if
/// there are none.
std::string unexpected_arguments_text(std::span<const std::string> arguments, std::span<const std::string> known);

/// The same of a command line that a CLI::App could not parse: the arguments that it did not take, compared with the
/// commands and options that it knows at that place.
template <class App>
std::string unexpected_arguments_of(const App& app) {
  const App* innermost = &app;
  while (!innermost->get_subcommands().empty()) innermost = innermost->get_subcommands().front();
  std::vector<std::string> known;
  for (const App* command : innermost->get_subcommands([](const App*) { return true; })) {
    known.push_back(command->get_name());
  }
  for (const auto* option : innermost->get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  return unexpected_arguments_text(app.remaining(true), known);
}

}  // namespace yuragi
