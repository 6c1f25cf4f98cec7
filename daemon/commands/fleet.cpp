// `yuragi fleet`: the daemons that share one wind, as their leader has heard them.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <variant>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/follow/company.hpp"
#include "daemon/follow/history_stream.hpp"
#include "daemon/follow/node_history.hpp"
#include "daemon/follow/questions.hpp"
#include "daemon/settings/config_file.hpp"
#include "daemon/settings/duration_text.hpp"
#include "daemon/settings/standard_output.hpp"

namespace yuragi::daemon::commands {
namespace {

/// In which a leader has replied; it is asked again meanwhile.
constexpr auto kPatience = std::chrono::seconds(8);
constexpr auto kAskAgainAfter = std::chrono::milliseconds(500);
/// The history is incomplete if its next message does not come within this time.
constexpr auto kMaxSilence = std::chrono::seconds(8);
/// A day of a thousand nodes, which comes faster than it is read.
constexpr std::size_t kMaxHistoryMessages = 300'000;

struct FleetOptions {
  std::filesystem::path config_file;
  bool as_json = false;
  bool shows_history = false;
};

/// Wakes who waits for messages.
struct Arrival {
  std::mutex mutex;
  std::condition_variable news;
  bool has_come = false;
};

/// A link, and who waits for what comes by it.
class WaitingLink {
 public:
  explicit WaitingLink(const follow::NatsSettings& settings)
      : link_(settings, {}, [arrival = arrival_] {
          const std::lock_guard lock(arrival->mutex);
          arrival->has_come = true;
          arrival->news.notify_one();
        }) {}

  follow::NatsLink& link() { return link_; }
  /// Waits until something comes, for so long at most.
  std::vector<follow::NatsMessage> wait(std::chrono::milliseconds at_most) {
    {
      std::unique_lock lock(arrival_->mutex);
      arrival_->news.wait_for(lock, at_most, [&] { return arrival_->has_come; });
      arrival_->has_come = false;
    }
    return link_.received();
  }
  /// Throws ExitError: why there is no connection, what the server does not permit, or else `otherwise`.
  [[noreturn]] void give_up(const std::string& otherwise) const {
    const follow::NatsLink::State state = link_.state();
    throw ExitError(kExitNoDaemon, !state.trouble.empty() ? state.trouble
                                   : state.is_connected   ? fmt::format("{} at {}", otherwise, state.server)
                                                          : "no connection to " + state.server);
  }

 private:
  const std::shared_ptr<Arrival> arrival_ = std::make_shared<Arrival>();
  follow::NatsLink link_;
};

/// The nodes by their place in the list, once all of them are there. Throws ExitError if no leader replies.
std::vector<follow::Node> ask_leader(const settings::LeadConfig& config) {
  WaitingLink waiting(follow::link_settings(config, "yuragi fleet"));
  follow::NatsLink& link = waiting.link();
  const auto question = encode(follow::Question{.about = follow::Question::About::kFleet});
  const auto given_up = std::chrono::steady_clock::now() + kPatience;
  std::map<std::size_t, follow::Node> nodes;
  while (std::chrono::steady_clock::now() < given_up) {
    if (link.state().is_connected) link.publish(config.channel + ".ask", question, link.inbox());
    for (const follow::NatsMessage& message : waiting.wait(kAskAgainAfter)) {
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
  waiting.give_up("no leader replies on the channel " + config.channel);
}

/// All that JetStream has of the last day. Throws ExitError if it has no history.
follow::FleetHistory ask_jetstream(const settings::LeadConfig& config) {
  follow::NatsSettings settings = follow::link_settings(config, "yuragi fleet --history");
  settings.max_waiting = kMaxHistoryMessages;
  WaitingLink waiting(settings);
  follow::NatsLink& link = waiting.link();
  const std::string subject = follow::history_subject_of(config.channel);
  const std::string stream = follow::history_stream_of(config.channel);
  const follow::StreamRequest request = follow::read_stream(config.channel, link.inbox(), 0);
  follow::FleetHistory history;
  std::optional<std::uint64_t> expected;
  std::uint64_t come = 0;
  bool has_asked = false;
  auto given_up = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < given_up) {
    // Once: each request would have all messages sent again.
    if (!has_asked && link.state().is_connected) {
      link.publish(request.subject, request.bytes, link.inbox());
      has_asked = true;
    }
    for (const follow::NatsMessage& message : waiting.wait(kAskAgainAfter)) {
      given_up = std::chrono::steady_clock::now() + kMaxSilence;
      if (message.subject == subject) {
        ++come;
        if (auto entries = follow::decode_node_entries(message.bytes)) history.take(std::move(*entries));
      } else if (const auto reply = follow::decode_stream_reply(message.bytes);
                 reply && reply->kind == follow::StreamReply::Kind::kReads) {
        if (!reply->is_success()) {
          throw ExitError(kExitNoDaemon,
                          fmt::format("the stream {} of the history cannot be read ({}): it is made by a leader that "
                                      "is connected: check that one runs, and its log",
                                      stream, reply->trouble));
        }
        expected = reply->messages;
      }
    }
    if (expected && come >= *expected) return history;
  }
  if (expected) waiting.give_up(fmt::format("only {} of {} messages of the history came: try again", come, *expected));
  waiting.give_up(
      "no history, because JetStream does not reply: if it does not in a minute either, add "
      "`jetstream { store_dir: \"/var/lib/nats\" }` to the configuration of nats-server, and restart it");
}

std::string state_of(const follow::Node& node) {
  if (node.is_silent) return "no word for " + settings::duration_text(std::floor(node.last_word_s));
  return node.report.attention.empty() ? "well" : node.report.attention.front();
}

std::string table_of(const std::vector<follow::Node>& nodes) {
  std::string text;
  for (const follow::Node& node : nodes) {
    const follow::NodeReport& report = node.report;
    // Without a tick it is known by its history only.
    const std::string last = report.tick == 0
                                 ? fmt::format("{:.1f} m/s in its last minutes", report.wind_m_s)
                                 : fmt::format("{:.1f} m/s from {:.0f} deg, tick {}, {:.0f} ms late", report.wind_m_s,
                                               report.wind_from_deg, report.tick, 1e3 * report.behind_s);
    const std::string clock =
        report.clock_offset_s ? fmt::format(", clock {:+.1f} ms", 1e3 * *report.clock_offset_s) : std::string();
    text += fmt::format("{}\n  {}{}, {}\n  {}\n  {}\n", report.name, last, clock, report.software, report.part,
                        state_of(node));
  }
  return text;
}

std::string hour_text(const follow::HistoryEntry& hour) {
  return fmt::format("{:%H:%M}", std::chrono::sys_seconds(std::chrono::seconds(hour.begin_utc_s)));
}

/// The hours without a word that follow each other are one line.
std::string table_of(const follow::FleetHistory& history, UtcTime now) {
  std::string text;
  for (const auto& [name, entries] : history.nodes()) {
    const auto hours = follow::hours_of(entries, now);
    text += fmt::format("{}\n", name);
    if (!entries.empty())
      text += fmt::format("  {}\n  {}\n", entries.rbegin()->second.software, entries.rbegin()->second.part);
    text += "  UTC     heard     wind         max          late       needed attention\n";
    for (std::size_t i = 0; i < hours.size(); ++i) {
      const follow::HistoryEntry& hour = hours[i];
      if (hour.seconds == 0) {
        const std::string first = hour_text(hour);
        while (i + 1 < hours.size() && hours[i + 1].seconds == 0) ++i;
        text += fmt::format("  {:<6}  no word{}\n", first,
                            &hours[i] == &hour ? "" : " up to and with " + hour_text(hours[i]));
        continue;
      }
      text += fmt::format("  {:<6}  {:>3} min  {:>5.1f} m/s  {:>7.1f} m/s  {:>6.0f} ms", hour_text(hour),
                          std::min(60U, (hour.seconds + 30) / 60), hour.mean_wind_m_s, hour.max_wind_m_s,
                          1e3 * hour.max_behind_s);
      if (hour.attention_s > 0)
        text += fmt::format("  {}: {}", settings::duration_text(hour.attention_s), hour.attention);
      text += '\n';
    }
  }
  return text;
}

nlohmann::ordered_json json_of(const follow::FleetHistory& history, UtcTime now) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const auto& [name, entries] : history.nodes()) {
    nlohmann::ordered_json hours = nlohmann::ordered_json::array();
    for (const follow::HistoryEntry& hour : follow::hours_of(entries, now)) {
      nlohmann::ordered_json one = {{"begin_utc_s", hour.begin_utc_s}, {"heard_s", hour.seconds}};
      if (hour.seconds > 0) {
        one.update({{"mean_wind_m_s", hour.mean_wind_m_s},
                    {"max_wind_m_s", hour.max_wind_m_s},
                    {"max_behind_s", hour.max_behind_s},
                    {"attention_s", hour.attention_s},
                    {"attention", hour.attention},
                    {"software", hour.software},
                    {"part", hour.part}});
      }
      hours.push_back(std::move(one));
    }
    all.push_back({{"node", name}, {"hours", std::move(hours)}});
  }
  return {{"nodes", std::move(all)}};
}

void show_fleet(const FleetOptions& options) {
  const settings::Config config = settings::load_config(options.config_file);
  if (!config.wind.lead.is_in_company())
    throw ExitError(kExitConfig, options.config_file.string() + ": [wind] has neither lead nor follow");
  follow::check_company(config);
  if (options.shows_history) {
    const follow::FleetHistory history = ask_jetstream(config.wind.lead);
    const UtcTime now = std::chrono::system_clock::now();
    if (options.as_json) {
      print_json(json_of(history, now));
    } else if (history.nodes().empty()) {
      settings::write_at_once("no node has handed in an entry yet: the first ones come within ten minutes\n");
    } else {
      settings::write_at_once(table_of(history, now));
    }
    return;
  }
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
      "--history: the last 24 hours of each node, by hour of UTC, as JetStream of nats-server has stored them.\n"
      "  yuragi fleet --config wall.toml\n"
      "--json: nodes (a list: node, software, part, wind_m_s, wind_from_deg, tick, behind_s, clock_offset_s or null,\n"
      "attention, last_word_s, is_silent); with --history: nodes (a list: node, hours, a list: begin_utc_s, heard_s,\n"
      "and if that is not 0, mean_wind_m_s, max_wind_m_s, max_behind_s, attention_s, attention, software, part).");
  auto options = std::make_shared<FleetOptions>();
  command->add_option("--config,-c", options->config_file, "a configuration of one of them (TOML)")
      ->required()
      ->type_name("FILE");
  command->add_flag("--history", options->shows_history, "the last 24 hours of each, by hour");
  add_json(*command, options->as_json);
  command->callback([options] { show_fleet(*options); });
}

}  // namespace

extern const Command kFleetCommand;
const Command kFleetCommand{add_fleet};

}  // namespace yuragi::daemon::commands
