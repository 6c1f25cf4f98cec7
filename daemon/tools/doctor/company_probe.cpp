#include "daemon/tools/doctor/company_probe.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "daemon/follow/company.hpp"
#include "daemon/follow/nats_link.hpp"

namespace yuragi::daemon::tools::doctor {
namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(20);

struct Probe {
  CompanyServerFacts facts;
  std::unique_ptr<follow::NatsLink> link;

  bool is_over() const { return facts.is_connected && (facts.is_led || !facts.trouble.empty()); }
  void look() {
    const follow::NatsLink::State state = link->state();
    facts.server = state.server;
    facts.is_connected = state.is_connected;
    facts.trouble = state.trouble;
    facts.is_led = facts.is_led || !link->received().empty();
  }
};

}  // namespace

std::vector<CompanyServerFacts> probe_company(const settings::LeadConfig& config, Nanoseconds time) {
  const follow::NatsSettings all = follow::link_settings(config, "yuragi doctor");
  std::vector<Probe> probes;
  for (const std::string& server : all.servers) {
    follow::NatsSettings one = all;
    one.servers = {server};
    probes.push_back(
        {.facts = {.channel = config.channel, .needs_leader = !config.follow.empty()},
         .link = std::make_unique<follow::NatsLink>(std::move(one), std::vector{config.channel + ".tick"}, [] {})});
  }
  const auto end = std::chrono::steady_clock::now() + time;
  bool is_over = false;
  while (!is_over && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(kBetweenLooks);
    is_over = true;
    for (Probe& probe : probes) {
      probe.look();
      is_over = is_over && probe.is_over();
    }
  }
  std::vector<CompanyServerFacts> facts;
  facts.reserve(probes.size());
  for (const Probe& probe : probes) facts.push_back(probe.facts);
  return facts;
}

}  // namespace yuragi::daemon::tools::doctor
