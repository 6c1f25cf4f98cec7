#include "daemon/tools/doctor/finding.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/base/count_text.hpp"

namespace yuragi::daemon::tools::doctor {

std::string_view name_of(Verdict verdict) {
  constexpr std::array<std::string_view, 3> kNames = {"ok", "warning", "error"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

Verdict gravest(std::span<const Finding> findings) {
  Verdict worst = Verdict::kOk;
  for (const Finding& finding : findings) worst = std::max(worst, finding.verdict);
  return worst;
}

std::string findings_text(std::span<const Finding> findings) {
  std::string text;
  for (const Finding& finding : findings) {
    text += fmt::format("{:<8} {:<14} {}\n", name_of(finding.verdict), finding.area, finding.text);
    if (!finding.remedy.empty()) text += fmt::format("{:<23} fix: {}\n", "", finding.remedy);
  }
  const auto count = [&](Verdict verdict) {
    return static_cast<std::uint64_t>(std::ranges::count(findings, verdict, &Finding::verdict));
  };
  return text + fmt::format("{}, {}\n", count_text(count(Verdict::kError), "error"),
                            count_text(count(Verdict::kWarning), "warning"));
}

nlohmann::ordered_json findings_json(std::span<const Finding> findings) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    all.push_back(
        {{"area", finding.area}, {"verdict", name_of(finding.verdict)}, {"text", finding.text}, {"remedy", nullptr}});
    if (!finding.remedy.empty()) all.back()["remedy"] = finding.remedy;
  }
  return {{"verdict", name_of(gravest(findings))}, {"findings", all}};
}

}  // namespace yuragi::daemon::tools::doctor
