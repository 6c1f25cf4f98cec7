// `yuragi fleet`: the daemons that share one wind, as their leader has heard them.
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/follow/company.hpp"
#include "daemon/follow/questions.hpp"
#include "daemon/settings/config_file.hpp"
#include "daemon/settings/duration_text.hpp"
#include "daemon/settings/standard_output.hpp"

namespace yuragi::daemon::commands {
namespace {

/// In which a leader has replied; it is asked again meanwhile.
constexpr auto kPatience = std::chrono::seconds(8);
constexpr auto kAskAgainAfter = std::chrono::milliseconds(500);

struct FleetOptions {
  std::filesystem::path config_file;
  bool as_json = false;
};

/// Wakes who waits for messages.
struct Arrival {
  std::mutex mutex;
  std::condition_variable news;
  bool has_come = false;
};

/// The nodes by their place in the list, once all of them are there. Throws ExitError if no leader replies.
std::vector<follow::Node> ask_leader(const settings::LeadConfig& config) {
  const auto arrival = std::make_shared<Arrival>();
  follow::NatsLink link(follow::link_settings(config, "yuragi fleet"), {}, [arrival] {
    const std::lock_guard lock(arrival->mutex);
    arrival->has_come = true;
    arrival->news.notify_one();
  });
  const auto question = encode(follow::Question{.about = follow::Question::About::kFleet});
  const auto given_up = std::chrono::steady_clock::now() + kPatience;
  std::map<std::size_t, follow::Node> nodes;
  while (std::chrono::steady_clock::now() < given_up) {
    if (link.state().is_connected) link.publish(config.channel + ".ask", question, link.inbox());
    {
      std::unique_lock lock(arrival->mutex);
      arrival->news.wait_for(lock, kAskAgainAfter, [&] { return arrival->has_come; });
      arrival->has_come = false;
    }
    for (const follow::NatsMessage& message : link.received()) {
      const auto reply = follow::decode_reply(message.bytes);
      const auto* list = reply ? std::get_if<follow::NodeList>(&*reply) : nullptr;
      if (list == nullptr) continue;
      for (std::size_t i = 0; i < list->nodes.size(); ++i) nodes[list->first + i] = list->nodes[i];
      if (nodes.size() < list->all) continue;
      std::vector<follow::Node> all;
      all.reserve(nodes.size());
      for (auto& [place, node] : nodes) all.push_back(std::move(node));
      return all;
    }
  }
  const follow::NatsLink::State state = link.state();
  throw ExitError(kExitNoDaemon, state.is_connected
                                     ? "no leader replies on the channel " + config.channel + " at " + state.server
                                 : state.trouble.empty() ? "no connection to " + state.server
                                                         : state.trouble);
}

std::string state_of(const follow::Node& node) {
  if (node.is_silent) return "no word for " + settings::duration_text(std::floor(node.last_word_s));
  return node.report.attention.empty() ? "well" : node.report.attention.front();
}

std::string table_of(const std::vector<follow::Node>& nodes) {
  std::string text;
  for (const follow::Node& node : nodes) {
    const follow::NodeReport& report = node.report;
    text += fmt::format("{}\n  {:.1f} m/s from {:.0f} deg, tick {}, {:.0f} ms late, {}\n  {}\n  {}\n", report.name,
                        report.wind_m_s, report.wind_from_deg, report.tick, 1e3 * report.behind_s, report.software,
                        report.part, state_of(node));
  }
  return text;
}

void show_fleet(const FleetOptions& options) {
  const settings::Config config = settings::load_config(options.config_file);
  if (!config.wind.lead.is_in_company())
    throw ExitError(kExitConfig, options.config_file.string() + ": [wind] has neither lead nor follow");
  follow::check_company(config);
  const std::vector<follow::Node> nodes = ask_leader(config.wind.lead);
  if (options.as_json) {
    print_json(follow::nodes_json(nodes));
  } else {
    settings::write_at_once(table_of(nodes));
  }
  for (const follow::Node& node : nodes) {
    if (node.is_silent || !node.report.attention.empty()) throw ExitError(kExitAttention, "");
  }
}

void add_fleet(CLI::App& app) {
  CLI::App* command = app.add_subcommand("fleet", "show all daemons that move in one wind ([wind] lead, follow)");
  command->footer(
      "Each daemon with its wind, its last tick and how late it makes one, its version, its part, and what needs\n"
      "attention, as its leader has heard it once a second. A node that is silent for more than 5 s is news.\n"
      "Exit code 0: all is well; 1: a node is silent or needs attention; 2: no leader replies.\n"
      "  yuragi fleet --config wall.toml\n"
      "--json: nodes (a list: node, is_silent, last_word_s, software, part, wind_m_s, wind_from_deg, tick, behind_s,\n"
      "attention).");
  auto options = std::make_shared<FleetOptions>();
  command->add_option("--config,-c", options->config_file, "a configuration of one of them (TOML)")
      ->required()
      ->type_name("FILE");
  add_json(*command, options->as_json);
  command->callback([options] { show_fleet(*options); });
}

}  // namespace

extern const Command kFleetCommand;
const Command kFleetCommand{add_fleet};

}  // namespace yuragi::daemon::commands
