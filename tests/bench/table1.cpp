#include "tests/bench/table1.hpp"

#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace yuragi::bench {
namespace {

std::optional<double> time_s(const Times& times, const std::string& name) {
  const auto found = times.find(name);
  return found == times.end() ? std::nullopt : std::optional(found->second);
}

/// The fastest way in which the row's bytes can be stored, and which way it is.
struct FastestStore {
  std::optional<double> time_s;
  const char* way = "";
};
FastestStore fastest_store(const Times& times, const std::string& row) {
  const auto by_memset = time_s(times, row + "/memset");
  const auto streamed = time_s(times, row + "/streamed");
  if (streamed && (!by_memset || *streamed < *by_memset)) return {streamed, "streamed"};
  return {by_memset, "memset"};
}

std::string cell_ms(std::optional<double> seconds) {
  return seconds ? fmt::format("{:9.4f}", *seconds * 1e3) : fmt::format("{:>9}", "-");
}

std::string ratio(std::optional<double> a, std::optional<double> b) {
  return a && b ? fmt::format("{:7.2f}", *a / *b) : fmt::format("{:>7}", "-");
}

}  // namespace

void print_table(std::ostream& out, const std::vector<TableRow>& rows, const Times& times) {
  out << fmt::format("{:<23}{:>9} {:>9}{:>9}{:>9}{:>9}{:>9} {:>8}{:>9}{:>7}{:>9} {:<9}{:>9}{:>7}   {}\n",
                     "one frame, ms", "nodes", "shift", "sample", "project", "total", "paced", "ns/node", "floor",
                     "floors", "store", "by", "plain", "times", "paper's total");
  for (const TableRow& row : rows) {
    const auto total = time_s(times, row.name + "/total");
    const auto floor = time_s(times, row.name + "/floor");
    const auto plain = time_s(times, row.name + "/plain");
    const FastestStore store = fastest_store(times, row.name);
    if (!total && !floor && !store.time_s) continue;  // left out by a filter
    out << fmt::format("{:<23}{:>9} {}{}{}{}{} {:8.3f}{}{}{} {:<9}{}{}", row.name, row.nodes,
                       cell_ms(time_s(times, row.name + "/shifting")), cell_ms(time_s(times, row.name + "/sampling")),
                       cell_ms(time_s(times, row.name + "/projection")), cell_ms(total),
                       cell_ms(time_s(times, row.name + "/paced")),
                       total.value_or(0.0) * 1e9 / static_cast<double>(row.nodes), cell_ms(floor), ratio(total, floor),
                       cell_ms(store.time_s), store.time_s ? store.way : "", cell_ms(plain), ratio(plain, total));
    if (row.paper) {
      out << fmt::format("   {} ({} + {} + {})", row.paper->total_ms, row.paper->shifting_ms, row.paper->sampling_ms,
                         row.paper->projection_ms);
    }
    out << '\n';
  }
  out << "\npaced: a frame each 1/60 s, total: one right behind the other; floor: a plain loop that stores 12 bytes a "
         "node, in which targets are stated; store: the same bytes as "
         "fast as "
         "this machine can\n";
}

void print_targets(std::ostream& out, const std::vector<Target>& targets) {
  for (const Target& target : targets) {
    out << fmt::format("{:<70}{:8.3f}   {} {:g}{}\n", target.what, target.value,
                       target.is_at_least ? "at least" : "at most", target.limit, target.is_met() ? "" : "   MISSED");
  }
}

void print_json(std::ostream& out, const std::vector<TableRow>& rows, const Times& times,
                const std::vector<Target>& targets) {
  nlohmann::ordered_json all;
  for (const TableRow& row : rows) {
    nlohmann::ordered_json entry = {{"name", row.name}, {"nodes", row.nodes}};
    for (const char* part :
         {"shifting", "sampling", "projection", "total", "paced", "floor", "memset", "streamed", "plain"}) {
      if (const auto time = time_s(times, row.name + "/" + part)) entry[std::string(part) + "_ms"] = *time * 1e3;
    }
    if (const FastestStore store = fastest_store(times, row.name); store.time_s) {
      entry["store_ms"] = *store.time_s * 1e3;
    }
    if (row.paper) {
      entry["paper_ms"] = {{"shifting", row.paper->shifting_ms},
                           {"sampling", row.paper->sampling_ms},
                           {"projection", row.paper->projection_ms},
                           {"total", row.paper->total_ms}};
    }
    all["rows"].push_back(entry);
  }
  for (const Target& target : targets) {
    all["targets"].push_back({{"what", target.what},
                              {"value", target.value},
                              {target.is_at_least ? "at_least" : "at_most", target.limit},
                              {"ratio", target.is_ratio},
                              {"met", target.is_met()}});
  }
  all["about"] = {
      {"shifting_ms, sampling_ms, projection_ms", "a frame's three parts; projection goes as far as joints"},
      {"total_ms", "a frame, right behind the other"},
      {"paced_ms", "a frame, 60 times a second: processor and caches have rested"},
      {"floor_ms", "a plain loop that stores 12 bytes a node, in which targets are stated"},
      {"memset_ms, streamed_ms", "the same bytes, stored by memset and past the caches"},
      {"store_ms", "the faster of these two: the least that this machine needs for them"},
      {"plain_ms", "a frame of plain code, compiled without vectors"},
      {"paper_ms", "the paper's table 1"}};
  out << all.dump(2) << '\n';
}

}  // namespace yuragi::bench
