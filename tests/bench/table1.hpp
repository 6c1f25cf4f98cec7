#pragma once

#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace yuragi::bench {

/// A row of the paper's table 1, read as milliseconds (Chiba, section 4).
struct PaperRow {
  double shifting_ms, sampling_ms, projection_ms, total_ms;
};

/// A row of ours. Times are named ROW/PART in the results. Parts are shifting, sampling, projection and total, a frame
/// right behind the other; paced, a frame each 1/60 s, as the daemon computes them: processor and caches have rested;
/// floor, a plain loop that stores 12 bytes a node, in which targets are stated; memset and streamed, the same bytes
/// stored by memset and past the caches, of which the faster is the least that this machine needs; plain, the plain
/// code.
struct TableRow {
  std::string name;
  std::size_t nodes = 0;
  std::optional<PaperRow> paper = std::nullopt;
};

/// What we ask of a measurement, and what it came to.
struct Target {
  std::string what;
  double value = 0.0;
  double limit = 0.0;
  bool is_at_least = false;  ///< else: at most
  bool is_ratio = true;      ///< of two times of one thread in this run, met by any machine; else it needs a fast one
  bool is_met() const { return is_at_least ? value >= limit : value <= limit; }
};

/// The fastest time of each measurement, seconds, by name.
using Times = std::map<std::string, double>;

void print_table(std::ostream& out, const std::vector<TableRow>& rows, const Times& times);
void print_targets(std::ostream& out, const std::vector<Target>& targets);

/// All of it as one JSON object: `rows`, each with name, nodes, the time of each part that was measured as PART_ms,
/// store_ms (the faster of memset_ms and streamed_ms) and paper_ms; `targets`; and `about`, which says what the parts
/// are.
void print_json(std::ostream& out, const std::vector<TableRow>& rows, const Times& times,
                const std::vector<Target>& targets);

}  // namespace yuragi::bench
