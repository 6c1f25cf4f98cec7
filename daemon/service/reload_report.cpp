#include "daemon/service/reload_report.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "engine/base/count_text.hpp"

namespace yuragi::daemon::service {

std::string without_path_folders(const std::string& text) {
  constexpr std::string_view kEnds = " \":;";
  std::string out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(kEnds, begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    out += word.starts_with('/') ? word.substr(word.rfind('/') + 1) : word;
    if (end < text.size()) out += text[end];
    begin = end + 1;
  }
  return out;
}

wire::ReloadReport without_folders(wire::ReloadReport report) {
  for (auto* const texts : {&report.applied, &report.takes_restart, &report.mistakes}) {
    for (std::string& text : *texts) text = without_path_folders(text);
  }
  return report;
}

std::string summary_of(const wire::ReloadReport& report) {
  if (report.outcome != wire::ReloadOutcome::kDone) {
    return "nothing was changed: " + (report.mistakes.empty() ? std::string() : report.mistakes.front());
  }
  const std::string warnings =
      report.mistakes.empty() ? "" : ", " + count_text(report.mistakes.size(), "warning") + " of the next start";
  return fmt::format("{} applied, {} to be applied by a restart{}", count_text(report.applied.size(), "change"),
                     report.takes_restart.size(), warnings);
}

}  // namespace yuragi::daemon::service
