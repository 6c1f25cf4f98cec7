#include "tests/answer/verdicts.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/answer/scene_run.hpp"

namespace yuragi::answer {
namespace {

constexpr std::string_view kQuotient = " / the number before";

/// What is asked of every record: that its wind is the test wind, and that joints keep their bound.
const std::array kCommonBounds = {
    Bound{"wind, mean / U", "", 3, {{{0.9, 1.1}, {0.9, 1.1}, {0.9, 1.1}, {0.9, 1.1}}}},
    Bound{"wind, intensity / 0.2", "", 3, {{{0.75, 1.25}, {0.75, 1.25}, {0.75, 1.25}, {0.75, 1.25}}}},
    Bound{"largest step of a joint / its bound", "", 3, {{at_most(1), at_most(1), at_most(1), at_most(1)}}},
};

std::optional<double> value_of(const std::optional<Figures>& figures, std::string_view name) {
  if (!figures) return std::nullopt;
  for (const Figure& figure : *figures) {
    if (figure.name == name) return figure.value;
  }
  return std::nullopt;
}

/// The value of a row at a Beaufort number; of a quotient nothing where one of its two was not recorded.
std::optional<double> value_at(const MeasuredScene& measured, std::string_view name, std::size_t number) {
  if (!name.ends_with(kQuotient)) return value_of(measured[number], name);
  name.remove_suffix(kQuotient.size());
  if (number == 0) return std::nullopt;
  const std::optional<double> here = value_of(measured[number], name);
  const std::optional<double> before = value_of(measured[number - 1], name);
  if (!here || !before) return std::nullopt;
  return *here / *before;
}

Verdict verdict_of(double value, const Range& range) {
  if (std::isnan(value)) return Verdict::kMissing;
  if (value < range.low) return Verdict::kLow;
  if (value > range.high) return Verdict::kHigh;
  return Verdict::kOk;
}

Judged judged(const MeasuredScene& measured, const Bound& bound, std::size_t number) {
  Judged cell{.value = value_at(measured, bound.figure, number), .range = bound.ranges[number]};
  if (cell.range.is_any()) return cell;
  const bool is_missing_other = bound.figure.ends_with(kQuotient) && !(measured[number] && measured[number - 1]);
  if (is_missing_other) return cell;
  cell.verdict = cell.value ? verdict_of(*cell.value, cell.range) : Verdict::kMissing;
  return cell;
}

template <class Is>
std::size_t count_cells(const std::vector<JudgedRow>& rows, Is is) {
  std::size_t count = 0;
  for (const JudgedRow& row : rows) {
    count += static_cast<std::size_t>(std::count_if(row.cells.begin(), row.cells.end(), is));
  }
  return count;
}

std::string range_text(const Range& range, int decimals) {
  if (range.is_any()) return "";
  // Bounds are said with as many digits as they have.
  const auto number = [decimals](double value) {
    std::string text = fmt::format("{:.{}f}", value, decimals + 1);
    while (text.ends_with('0')) text.pop_back();
    if (text.ends_with('.')) text.pop_back();
    return text;
  };
  if (std::isinf(range.low)) return "<=" + number(range.high);
  if (std::isinf(range.high)) return ">=" + number(range.low);
  return number(range.low) + ".." + number(range.high);
}

std::string cell_text(const Judged& cell, int decimals) {
  const std::string value = cell.value ? fmt::format("{:.{}f}", *cell.value, decimals) : "-";
  return fmt::format("{:>8} {:<13} {:<4}", value, range_text(cell.range, decimals), verdict_text(cell.verdict));
}

}  // namespace

std::string_view verdict_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk:
      return "ok";
    case Verdict::kLow:
      return "LOW";
    case Verdict::kHigh:
      return "HIGH";
    case Verdict::kMissing:
      return "NONE";
    case Verdict::kNotJudged:
      break;
  }
  return "";
}

std::vector<JudgedRow> judge(const SceneTable& table, const MeasuredScene& measured,
                             const std::array<bool, kBeauforts>& is_asked) {
  std::vector<Bound> bounds(kCommonBounds.begin(), kCommonBounds.end());
  if (described(table.scene).is_still_in_calm) {
    bounds.push_back({"in calm: numbers off the rest pose", "", 0, {{at_most(0), kAny, kAny, kAny}}});
  }
  if (table.largest_turn_deg > 0.0) {
    const Range turn = at_most(table.largest_turn_deg);
    bounds.push_back({"from downwind, at most of 8 directions", "deg", 1, {{kAny, turn, turn, turn}}});
  }
  bounds.insert(bounds.end(), table.bounds.begin(), table.bounds.end());
  std::vector<JudgedRow> rows;
  for (const Bound& bound : bounds) {
    JudgedRow row{.bound = bound, .cells = {}};
    for (std::size_t number = 0; number < kBeauforts; ++number) {
      if (is_asked[number] && measured[number]) row.cells[number] = judged(measured, bound, number);
    }
    rows.push_back(row);
  }
  return rows;
}

std::size_t judgements(const std::vector<JudgedRow>& rows) {
  return count_cells(rows, [](const Judged& cell) { return cell.verdict != Verdict::kNotJudged; });
}

std::size_t failures(const std::vector<JudgedRow>& rows) {
  return count_cells(rows, [](const Judged& cell) { return cell.fails(); });
}

std::string table_text(const SceneTable& table, const std::vector<JudgedRow>& rows,
                       const std::array<bool, kBeauforts>& is_asked) {
  std::string text = fmt::format("{:<48}", table.name);
  for (std::size_t number = 0; number < kBeauforts; ++number) {
    if (is_asked[number]) text += fmt::format("Beaufort {:<20}", kBeaufort[number]);
  }
  text += '\n';
  for (const JudgedRow& row : rows) {
    const std::string unit = row.bound.unit.empty() ? "" : fmt::format(", {}", row.bound.unit);
    text += fmt::format("  {:<44}", fmt::format("{}{}", row.bound.figure, unit));
    for (std::size_t number = 0; number < kBeauforts; ++number) {
      if (is_asked[number]) text += cell_text(row.cells[number], row.bound.decimals) + "  ";
    }
    text += '\n';
  }
  return text;
}

nlohmann::json to_json(const SceneTable& table, const MeasuredScene& measured, const std::vector<JudgedRow>& rows) {
  const auto limit = [](double value) { return std::isinf(value) ? nlohmann::json() : nlohmann::json(value); };
  nlohmann::json all;
  all["scene"] = table.name;
  for (std::size_t number = 0; number < kBeauforts; ++number) {
    if (!measured[number]) continue;
    nlohmann::json& figures = all["measured"][std::to_string(kBeaufort[number])];
    for (const Figure& figure : *measured[number]) figures[figure.name] = limit(figure.value);
  }
  for (const JudgedRow& row : rows) {
    for (std::size_t number = 0; number < kBeauforts; ++number) {
      const Judged& cell = row.cells[number];
      if (!cell.value && cell.verdict == Verdict::kNotJudged) continue;
      all["figures"].push_back({{"figure", row.bound.figure},
                                {"unit", row.bound.unit},
                                {"beaufort", kBeaufort[number]},
                                {"value", cell.value ? limit(*cell.value) : nlohmann::json()},
                                {"low", limit(cell.range.low)},
                                {"high", limit(cell.range.high)},
                                {"verdict", verdict_text(cell.verdict)}});
    }
  }
  return all;
}

MeasuredScene measured_of(const nlohmann::json& scene) {
  MeasuredScene measured;
  for (std::size_t number = 0; number < kBeauforts; ++number) {
    const auto found = scene.at("measured").find(std::to_string(kBeaufort[number]));
    if (found == scene.at("measured").end()) continue;
    Figures& figures = measured[number].emplace();
    for (const auto& [name, value] : found->items()) {
      // JSON has no infinity, and a record has none but of a speed without a lag.
      figures.push_back({name, value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>()});
    }
  }
  return measured;
}

}  // namespace yuragi::answer
