#include "daemon/follow/fleet.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/follow/small_json.hpp"
#include "daemon/settings/duration_text.hpp"
#include "engine/base/json_text.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::follow {
namespace {

constexpr std::size_t kMaxAttention = 5, kMaxText_bytes = 300;
constexpr std::size_t kNodesInMessage = 50;

nlohmann::ordered_json json_of(const NodeReport& report) {
  nlohmann::ordered_json attention = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < std::min(report.attention.size(), kMaxAttention); ++i)
    attention.push_back(shortened(report.attention[i], kMaxText_bytes / 4));
  return {{"node", report.name},
          {"software", report.software},
          {"part", report.part},
          {"wind_m_s", report.wind_m_s},
          {"wind_from_deg", report.wind_from_deg},
          {"tick", report.tick},
          {"behind_s", report.behind_s},
          {"clock_offset_s", report.clock_offset_s ? nlohmann::ordered_json(*report.clock_offset_s) : nullptr},
          {"attention", std::move(attention)}};
}

nlohmann::ordered_json json_of(const std::vector<Node>& nodes) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Node& node : nodes) {
    nlohmann::ordered_json json = json_of(node.report);
    json["last_word_s"] = node.last_word_s;
    json["is_silent"] = node.is_silent;
    all.push_back(std::move(json));
  }
  return all;
}

Result<NodeReport, Failure> report_of(const nlohmann::json& json) {
  if (!json.is_object()) return bad_data("is no report of a node");
  auto name = text_at(json, "node", kMaxText_bytes), software = text_at(json, "software", kMaxText_bytes),
       part = text_at(json, "part", kMaxText_bytes);
  const auto wind_m_s = number_at(json, "wind_m_s", 1e3), from_deg = number_at(json, "wind_from_deg", 360.0);
  const auto behind_s = number_at(json, "behind_s", 1e9);
  const auto tick = count_at(json, "tick");
  const auto attention = json.find("attention");
  if (!name || name->empty() || !software || !part || !wind_m_s || !from_deg || !behind_s || !tick ||
      attention == json.end() || !attention->is_array() || attention->size() > kMaxAttention) {
    return bad_data("is a report with a key that is missing or has no such value");
  }
  NodeReport report{.name = std::move(*name),
                    .software = std::move(*software),
                    .part = std::move(*part),
                    .wind_m_s = *wind_m_s,
                    .wind_from_deg = *from_deg,
                    .tick = *tick,
                    .behind_s = *behind_s,
                    .clock_offset_s = number_at(json, "clock_offset_s", 1e9),  // others may not have it
                    .attention = {}};
  for (const nlohmann::json& one : *attention) {
    auto text = short_text(one, kMaxText_bytes);
    if (!text) return bad_data("has an attention that is no short text");
    report.attention.push_back(std::move(*text));
  }
  return report;
}

}  // namespace

void Fleet::take(NodeReport report, MonoTime now) {
  std::erase_if(heard_, [now](const auto& node) { return now - node.second.at > kForgottenAfter; });
  const std::string name = report.name;
  if (heard_.size() >= kMaxNodes && !heard_.contains(name)) return;
  heard_[name] = {std::move(report), now};
}

void Fleet::learn(NodeReport report, Nanoseconds age, MonoTime now) {
  if (age < Nanoseconds::zero() || age > kForgottenAfter) return;
  const auto heard = heard_.find(report.name);
  if (heard == heard_.end() ? heard_.size() >= kMaxNodes : heard->second.at >= now - age) return;
  const std::string name = report.name;
  heard_[name] = {std::move(report), now - age};
}

std::vector<Node> Fleet::nodes(MonoTime now) const {
  std::vector<Node> nodes;
  for (const auto& [name, heard] : heard_) {
    nodes.push_back({.report = heard.report,
                     .last_word_s = std::max(0.0, seconds(now - heard.at)),
                     .is_silent = now - heard.at > kSilentAfter});
  }
  return nodes;
}

std::vector<std::string> Fleet::attention(const std::string& own, MonoTime now, std::size_t most) const {
  std::vector<std::string> sentences;
  for (const Node& node : nodes(now)) {
    const NodeReport& report = node.report;
    if (report.name == own) continue;
    if (node.is_silent) {
      sentences.push_back(fmt::format("node {}: no word for {}: is the machine on, and its network?", report.name,
                                      settings::duration_text(std::floor(node.last_word_s))));
    } else if (!report.attention.empty()) {
      sentences.push_back(fmt::format("node {}: {}", report.name, report.attention.front()));
    }
  }
  if (sentences.size() <= most) return sentences;
  const std::size_t others = sentences.size() - most;
  sentences.resize(most);
  sentences.push_back(fmt::format("and {} more nodes: see `yuragi fleet`", others));
  return sentences;
}

std::vector<std::uint8_t> encode(const NodeReport& report) {
  return bytes_of(json_of(report));
}

Result<NodeReport, Failure> decode_node_report(std::span<const std::uint8_t> bytes) {
  return report_of(small_json(bytes));
}

std::vector<std::uint8_t> list_bytes(const NodeList& list) {
  return bytes_of({{"all", list.all}, {"first", list.first}, {"nodes", json_of(list.nodes)}});
}

Result<NodeList, Failure> decode_node_list(std::span<const std::uint8_t> bytes) {
  const nlohmann::json json = small_json(bytes);
  if (!json.is_object()) return bad_data("is no list of nodes");
  const auto all = number_at(json, "all", Fleet::kMaxNodes), first = number_at(json, "first", Fleet::kMaxNodes);
  const auto nodes = json.find("nodes");
  if (!all || *all < 0.0 || !first || *first < 0.0 || nodes == json.end() || !nodes->is_array() ||
      nodes->size() > kNodesInMessage) {
    return bad_data("is no list of nodes");
  }
  NodeList list{.all = static_cast<std::size_t>(*all), .first = static_cast<std::size_t>(*first), .nodes = {}};
  for (const nlohmann::json& one : *nodes) {
    auto report = report_of(one);
    if (!report) return report.error();
    const auto last_word_s = number_at(one, "last_word_s", 1e9);
    const auto is_silent = one.find("is_silent");
    if (!last_word_s || is_silent == one.end() || !is_silent->is_boolean()) return bad_data("has a node that is none");
    list.nodes.push_back(
        {.report = std::move(*report), .last_word_s = *last_word_s, .is_silent = is_silent->get<bool>()});
  }
  return list;
}

nlohmann::ordered_json nodes_json(const std::vector<Node>& nodes) {
  return {{"nodes", json_of(nodes)}};
}

std::string nodes_text(const std::vector<Node>& nodes) {
  return json_text(nodes_json(nodes), 2) + "\n";
}

std::vector<NodeList> parts_of(const std::vector<Node>& nodes) {
  std::vector<NodeList> parts;
  for (std::size_t first = 0; first < nodes.size() || parts.empty(); first += kNodesInMessage) {
    const std::size_t end = std::min(nodes.size(), first + kNodesInMessage);
    parts.push_back({.all = nodes.size(),
                     .first = first,
                     .nodes = std::vector<Node>(nodes.begin() + static_cast<std::ptrdiff_t>(first),
                                                nodes.begin() + static_cast<std::ptrdiff_t>(end))});
  }
  return parts;
}

}  // namespace yuragi::daemon::follow
