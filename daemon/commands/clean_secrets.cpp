// `yuragi clean-secrets`: takes passwords out of recordings of versions that recorded them.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/settings/withhold_secrets.hpp"
#include "drivers/windlog/windlog_rewrite.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::commands {

extern const Command kCleanSecretsCommand;

namespace {

constexpr const char* kCleanSecretsFooter =
    "Versions up to 0.2 recorded a password that stood in the configuration. \"(secret)\" is written in its place, "
    "and\n"
    "the file is rewritten so that its bytes are gone; readings stay as they are. Nothing may have the file open, and\n"
    "there must be room for the file once more. Other copies of it, and what the disk has not yet reused, still hold "
    "the\n"
    "password: change it, too.\n"
    "\n"
    "Example:\n"
    "  yuragi clean-secrets old.windlog storm.windlog";

/// What was found in one recording.
struct FoundSecrets {
  std::size_t secrets = 0;
  std::size_t unreadable_texts = 0;

  std::optional<std::string> take(const Result<settings::WithheldText, Failure>& withheld) {
    if (!withheld) {
      ++unreadable_texts;
      return std::nullopt;
    }
    secrets += withheld->secrets;
    return withheld->secrets > 0 ? std::optional(withheld->text) : std::nullopt;
  }
};

/// Throws ExitError.
void clean_one(const std::string& file) {
  FoundSecrets found;
  const auto rewritten = drivers::windlog::rewrite_texts(
      file, {.configuration =
                 [&found](const std::string& text) { return found.take(settings::withhold_in_configuration(text)); },
             .options =
                 [&found](const std::string& driver, const std::string& text) {
                   return found.take(settings::withhold_in_options(text, driver));
                 }});
  if (!rewritten) throw ExitError(exit_code_of(rewritten.error().kind), rewritten.error().message);
  fmt::print("{}: {}\n", file,
             found.secrets == 0 ? "has no secrets in it" : count_text(found.secrets, "secret") + " taken out");
  if (found.unreadable_texts > 0) {
    throw ExitError(kExitDataError,
                    fmt::format("{}: {} cannot be read as TOML; each was left unchanged and may contain secrets", file,
                                count_text(found.unreadable_texts, "configuration")));
  }
}

void clean_secrets(const std::vector<std::string>& files) {
  std::string messages;
  std::optional<int> code;
  for (const std::string& file : files) {
    try {
      clean_one(file);
    } catch (const ExitError& error) {
      messages.append(messages.empty() ? "" : "\n").append(error.what());
      if (!code) code = error.code();
    }
  }
  if (code) throw ExitError(*code, messages);
}

void add_clean_secrets(CLI::App& app) {
  const auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("clean-secrets", "take passwords out of recordings of older versions");
  command->footer(kCleanSecretsFooter);
  command->add_option("files", *files, "the recordings (.windlog)")->required()->type_name("FILE.windlog");
  command->callback([files] { clean_secrets(*files); });
}

}  // namespace

const Command kCleanSecretsCommand{add_clean_secrets};

}  // namespace yuragi::daemon::commands
