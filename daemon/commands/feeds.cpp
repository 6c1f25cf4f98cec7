// `yuragi feeds rest`: brings lamps and fans to rest after the daemon has ended without doing so.
#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/feeds/dmx_rest.hpp"
#include "daemon/settings/config.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr const char* kRestFooter =
    "Receivers of DMX hold the last level if the daemon crashes or is killed. This sends the level of rest of each\n"
    "[[dmx]] to them: 25 packets and three that end the stream, in less than a second. The systemd unit runs it\n"
    "whenever the daemon has ended. Do not run it beside a running daemon.\n"
    "  yuragi feeds rest --config wall.toml\n"
    "Exit code 0: done, or there is no [[dmx]]; 69: a receiver cannot be reached; 78: the configuration has a mistake.";

/// As fast as DMX512 itself is.
constexpr auto kInterval = std::chrono::milliseconds(23);
/// For the look-up of a host, and a network that is being started.
constexpr auto kGiveUpAfter = std::chrono::seconds(5);

void send_rest(const std::filesystem::path& file) {
  const settings::Config config = settings::load_config(file);
  spdlog::set_level(spdlog::level::off);  // troubles are printed below
  std::deque<feeds::DmxRest> all;
  for (const settings::feeds::Dmx& dmx : config.feeds.dmx) all.emplace_back(dmx);
  const auto is_over = [&all] { return std::ranges::all_of(all, &feeds::DmxRest::is_over); };
  for (const MonoTime began = std::chrono::steady_clock::now();
       !is_over() && std::chrono::steady_clock::now() - began < kGiveUpAfter;) {
    for (feeds::DmxRest& rest : all) rest.step(std::chrono::steady_clock::now());
    if (!is_over()) std::this_thread::sleep_for(kInterval);
  }
  std::string troubles;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const settings::feeds::Dmx& dmx = config.feeds.dmx[i];
    const std::string trouble = all[i].trouble();
    if (trouble.empty() && all[i].is_over()) {
      fmt::print("{}: at rest ({})\n", dmx.name, dmx.target(0));
      continue;
    }
    troubles += troubles.empty() ? "" : "\nyuragi: ";
    troubles += fmt::format("{}: {}", dmx.name, trouble.empty() ? "no reply to the look-up of the host" : trouble);
  }
  if (!troubles.empty()) throw ExitError(kExitUnavailable, troubles);
}

void add_feeds(CLI::App& app) {
  CLI::App* feeds = app.add_subcommand("feeds", "what is sent to other programs and devices");
  feeds->require_subcommand(1);
  CLI::App* rest = feeds->add_subcommand("rest", "bring lamps and fans to rest after the daemon was killed");
  rest->footer(kRestFooter);
  const auto file = std::make_shared<std::filesystem::path>();
  rest->add_option("--config,-c", *file, "the daemon's configuration (TOML)")->required()->type_name("FILE");
  rest->callback([file] { send_rest(*file); });
}

}  // namespace

extern const Command kFeedsCommand;
const Command kFeedsCommand{add_feeds};

}  // namespace yuragi::daemon::commands
