#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace yuragi::daemon::tools::doctor {

enum class Verdict : std::uint8_t { kOk, kWarning, kError };
std::string_view name_of(Verdict verdict);

/// A finding about one thing.
struct Finding {
  Verdict verdict = Verdict::kOk;
  std::string area;    ///< one word: "sensor", "disk", "clock"
  std::string text;    ///< the state, or what is wrong
  std::string remedy;  ///< the command that fixes it, or what else to do; empty if nothing is wrong

  bool operator==(const Finding&) const = default;
};

/// The gravest of the verdicts; kOk if there are no findings.
Verdict gravest(std::span<const Finding> findings);

/// A line for each finding, with its remedy below, and how many are grave on the last line.
std::string findings_text(std::span<const Finding> findings);

/// {"verdict": "ok", "warning" or "error", "findings": [{"area", "verdict", "text", "remedy"}]}; remedy is null if
/// there is none.
nlohmann::ordered_json findings_json(std::span<const Finding> findings);

}  // namespace yuragi::daemon::tools::doctor
