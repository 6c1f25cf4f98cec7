#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/answer/figures.hpp"
#include "tests/answer/scene_table.hpp"

namespace yuragi::answer {

/// The figures of a scene by Beaufort number; nothing of a number that was not recorded.
using MeasuredScene = std::array<std::optional<Figures>, kBeauforts>;

enum class Verdict : std::uint8_t { kOk, kLow, kHigh, kMissing, kNotJudged };
std::string_view verdict_text(Verdict verdict);

/// A cell of a table.
struct Judged {
  std::optional<double> value;
  Range range = kAny;
  Verdict verdict = Verdict::kNotJudged;

  bool fails() const { return verdict != Verdict::kOk && verdict != Verdict::kNotJudged; }
};

/// A row of a table, judged: what is not finite is no number within any range, but infinity is above it.
struct JudgedRow {
  Bound bound;
  std::array<Judged, kBeauforts> cells;
};

/// The table's rows, those that are asked of every scene first. A row whose name ends in "/ the number before" is a
/// quotient of the row without that at two neighbouring Beaufort numbers; it is not judged where one was not recorded.
/// `is_asked`: the numbers that are judged.
std::vector<JudgedRow> judge(const SceneTable& table, const MeasuredScene& measured,
                             const std::array<bool, kBeauforts>& is_asked);

/// How many cells are judged, and how many of them are not as they should be.
std::size_t judgements(const std::vector<JudgedRow>& rows);
std::size_t failures(const std::vector<JudgedRow>& rows);

/// A table as text.
std::string table_text(const SceneTable& table, const std::vector<JudgedRow>& rows,
                       const std::array<bool, kBeauforts>& is_asked);

// Measured figures as JSON: what a run leaves for later ones to judge.
nlohmann::json to_json(const SceneTable& table, const MeasuredScene& measured, const std::vector<JudgedRow>& rows);
MeasuredScene measured_of(const nlohmann::json& scene);

}  // namespace yuragi::answer
