#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::follow {

/// A daemon's word on itself, once a second, to whoever keeps the list of all.
struct NodeReport {
  std::string name;  ///< [wind] node: where it is
  std::string software;
  std::string part;  ///< Company::Status::part
  double wind_m_s = 0.0;
  double wind_from_deg = 0.0;
  std::uint64_t tick = 0;
  double behind_s = 0.0;                      ///< how late it makes a tick
  std::optional<double> clock_offset_s = {};  ///< its clock less UTC; nullopt: unknown, or not watched there
  std::vector<std::string> attention;         ///< what needs a person's; empty: all is well
};

/// The same, as the list has it.
struct Node {
  NodeReport report;
  double last_word_s = 0.0;  ///< its age
  bool is_silent = false;
};

/// A part of the list, in one message.
struct NodeList {
  std::size_t all = 0;    ///< how many there are
  std::size_t first = 0;  ///< the number of the first one here
  std::vector<Node> nodes;
};

/// Every node that was heard, by its name. Bounded; belongs to one thread.
class Fleet {
 public:
  /// A node that is silent for this long is missed; for kForgottenAfter, it is gone.
  static constexpr std::chrono::seconds kSilentAfter{5};
  static constexpr std::chrono::hours kForgottenAfter{24 * 7};
  static constexpr std::size_t kMaxNodes = 1000;

  void take(NodeReport report, MonoTime now);
  /// Learns of a report from the history, which is so old. It counts only if it is newer than what was heard.
  void learn(NodeReport report, Nanoseconds age, MonoTime now);

  std::size_t size() const noexcept { return heard_.size(); }
  /// In the order of their names.
  std::vector<Node> nodes(MonoTime now) const;

  /// What needs a person's attention, a sentence for each node; of `own` only what others have. At most `most`, and one
  /// for the rest.
  std::vector<std::string> attention(const std::string& own, MonoTime now, std::size_t most = 8) const;

 private:
  struct Heard {
    NodeReport report;
    MonoTime at{};
  };
  std::map<std::string, Heard> heard_;
};

// JSON, bounded; a failure (kBadData) has a clause without a subject. Texts are printable.
std::vector<std::uint8_t> encode(const NodeReport& report);
Result<NodeReport, Failure> decode_node_report(std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> list_bytes(const NodeList& list);
Result<NodeList, Failure> decode_node_list(std::span<const std::uint8_t> bytes);

/// For people's programs: {"nodes": [{"node", "software", "part", "wind_m_s", "wind_from_deg", "tick", "behind_s",
/// "clock_offset_s" (or null), "attention", "last_word_s", "is_silent"}]}.
nlohmann::ordered_json nodes_json(const std::vector<Node>& nodes);
std::string nodes_text(const std::vector<Node>& nodes);

/// The list in messages of some nodes each; one without nodes if there are none.
std::vector<NodeList> parts_of(const std::vector<Node>& nodes);

}  // namespace yuragi::daemon::follow
