// `yuragi token`: shows a code that lets a browser of another machine in, makes the token behind it, and lists and ends
// the sessions of such browsers.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/commands/ask_page.hpp"
#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/web/access.hpp"
#include "daemon/web/routes.hpp"
#include "engine/base/json_text.hpp"
#include "engine/base/time.hpp"
#include "engine/platform/secret_file.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr const char* kTokenFooter =
    "[http] token_file in the configuration names the token's file. A browser on another machine is paired for a\n"
    "year with the code, which changes every ten minutes; scripts send the token: Authorization: Bearer TOKEN.\n"
    "  yuragi token --config wall.toml               shows the present code\n"
    "  yuragi token --config wall.toml --new         makes a new token; the old one ends when the daemon restarts\n"
    "  yuragi token --config wall.toml --sessions    lists the paired browsers\n"
    "  yuragi token --config wall.toml --revoke ID   ends a session: the next request of its browser is refused\n"
    "The token's file can be read by its owner and by the group of the configuration's file. --sessions and\n"
    "--revoke send the token to the daemon at [http] listen: run them as a user who may read the file (with the\n"
    "packaged service: root and the group yuragi).\n"
    "--json: pairing_code, valid_s (how long the code is valid); with --sessions: sessions, each with id, since_s,\n"
    "last_use_s (both since 1970; the last use to an hour) and address.\n"
    "Exit code 0: done; 69: there is no token yet, or no daemon replies; 70: the daemon refuses it, for example\n"
    "because the session does not exist; 73: the token's file cannot be written; 77: the daemon has another token;\n"
    "78: the configuration has a mistake, or names no file.";

struct TokenOptions {
  std::filesystem::path config_file;
  bool makes_new = false;
  bool lists_sessions = false;
  std::optional<std::string> revoked_id;
  bool as_json = false;
};

/// Nobody else can read it at any moment. Throws FailureError.
void write_token(const std::filesystem::path& file, const std::filesystem::path& config_file) {
  platform::OutputFile output(file, true);
  const std::string path = output.working_path().string();
  const auto fail = [&path](const char* what) {
    throw FailureError(
        {path + ": " + what + ": " + std::generic_category().message(errno), FailureKind::kCannotCreate});
  };
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor < 0) fail("cannot be created");
  const std::string line = web::Access::new_token().reveal() + "\n";
  struct stat config {};
  const bool is_written = ::write(descriptor, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  // The daemon's group, if this process may give the file to it.
  const bool is_given = ::stat(config_file.c_str(), &config) == 0 &&
                        ::fchown(descriptor, static_cast<uid_t>(-1), config.st_gid) == 0 &&
                        ::fchmod(descriptor, S_IRUSR | S_IWUSR | S_IRGRP) == 0;
  const bool is_on_disk = is_written && ::fsync(descriptor) == 0;
  if (::close(descriptor) != 0 || !is_on_disk) fail("cannot be written");
  if (const auto done = output.commit(); !done) throw FailureError(done.error());
  fmt::print(stderr, "{}: new token, readable by {}; restart the daemon\n", file.string(),
             is_given ? "its owner and the configuration's group" : "its owner alone");
}

std::string time_text(const nlohmann::json& utc_s) {
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(static_cast<std::time_t>(utc_s.get<std::int64_t>())));
}

void show_sessions(const PageRequest& request, bool as_json) {
  const nlohmann::json answer = ask_page(request);
  if (as_json) return print_json(answer);
  const nlohmann::json& sessions = answer.at("sessions");
  if (sessions.empty()) return fmt::print("no browser is paired\n");
  fmt::print("{:<10}  {:<16}  {:<16}  {}\n", "id", "since (UTC)", "last use (UTC)", "address");
  for (const nlohmann::json& session : sessions) {
    fmt::print("{:<10}  {:<16}  {:<16}  {}\n", session.at("id").get<std::string>(), time_text(session.at("since_s")),
               time_text(session.at("last_use_s")), session.at("address").get<std::string>());
  }
}

/// Asks the running daemon for the sessions, or to end one.
void handle_sessions(const TokenOptions& options, const settings::HttpConfig& http, const Secret& token) {
  if (http.listen.empty()) {
    throw ExitError(
        kExitConfig,
        options.config_file.string() +
            ": [http] listen is missing, so no browser can be paired with this daemon; set it to HOST:PORT");
  }
  PageRequest request{
      .listen = http.listen, .path = std::string(web::kSessionsPath), .token = token, .certificate = http.certificate};
  if (!options.revoked_id) return show_sessions(request, options.as_json);
  request.body = json_text(nlohmann::json{{"revoke", *options.revoked_id}});
  ask_page(request);
  fmt::print(stderr, "{}: revoked; the next request of this browser is refused\n", *options.revoked_id);
}

void show_token(const TokenOptions& options) {
  const settings::Config config = settings::load_config(options.config_file);
  const std::filesystem::path file = config.http.token_file;
  if (file.empty()) {
    throw ExitError(kExitConfig, options.config_file.string() +
                                     ": [http] token_file is missing: name a file for the token, such as "
                                     "token_file = \"/etc/yuragi/token\"");
  }
  if (options.makes_new) write_token(file, options.config_file);
  const auto token = platform::secret_in_file(file);
  if (!token)
    throw ExitError(kExitUnavailable, "token_file: " + token.error().message + "; `yuragi token --new` makes one");

  if (options.lists_sessions || options.revoked_id) return handle_sessions(options, config.http, *token);
  const double utc_s = seconds(std::chrono::system_clock::now().time_since_epoch());
  const double step_s = web::Access::kCodeStep_s;
  const double left_s = 2.0 * step_s - std::fmod(utc_s, step_s);
  const std::string code = web::Access(*token).pairing_code(utc_s);
  if (options.as_json) return print_json({{"pairing_code", code}, {"valid_s", left_s}});
  fmt::print("pairing code: {}, for {:.0f} minutes\n", code, std::floor(left_s / 60.0));
}

void add_token_command(CLI::App& app) {
  const auto options = std::make_shared<TokenOptions>();
  CLI::App* token = app.add_subcommand("token", "let browsers of other machines change something");
  token->add_option("--config", options->config_file, "the daemon's configuration (TOML)")
      ->required()
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  CLI::Option* const makes_new = token->add_flag("--new", options->makes_new, "make a new token first");
  CLI::Option* const sessions =
      token->add_flag("--sessions", options->lists_sessions, "list the browsers that were paired")->excludes(makes_new);
  token->add_option("--revoke", options->revoked_id, "end the session of a browser")
      ->type_name("ID")
      ->excludes(makes_new)
      ->excludes(sessions);
  add_json(*token, options->as_json);
  token->footer(kTokenFooter);
  token->callback([options] { show_token(*options); });
}

}  // namespace

extern const Command kTokenCommand;
const Command kTokenCommand{add_token_command};

}  // namespace yuragi::daemon::commands
