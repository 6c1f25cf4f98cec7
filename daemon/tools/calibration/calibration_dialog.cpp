#include "daemon/tools/calibration/calibration_dialog.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/settings/standard_output.hpp"
#include "daemon/tools/calibration/calibration_report.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::calibration {
namespace {

constexpr double kLineInterval_s = 5.0;

/// A line from standard input, trimmed. Throws at its end.
std::string read_line() {
  std::string line;
  if (!std::getline(std::cin, line)) {
    throw FailureError({"the input ended before an answer; nothing was written", FailureKind::kUsage});
  }
  const std::size_t begin = line.find_first_not_of(" \t\r");
  return begin == std::string::npos ? "" : line.substr(begin, line.find_last_not_of(" \t\r") - begin + 1);
}

}  // namespace

Dialog::Dialog(bool takes_yes, Report* report)
    : report_(report),
      takes_yes_(takes_yes),
      has_person_(report == nullptr && !takes_yes && isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0),
      is_watched_(isatty(STDERR_FILENO) != 0) {}

void Dialog::print(const std::string& text) const {
  if (report_ != nullptr) return report_->note(text);
  settings::write_at_once(text + "\n");
}

void Dialog::wait_until_prepared(const std::string& what) const {
  if (report_ != nullptr) return;  // whoever started this has prepared it
  print(what);
  if (!has_person_) return;
  settings::write_at_once("Press Enter when ready, Ctrl-C to quit: ");
  read_line();
}

double Dialog::prompt_number(const std::string& question, double least, double most) const {
  for (;;) {
    settings::write_at_once(fmt::format("{} ({:g} to {:g}): ", question, least, most));
    const std::string line = read_line();
    double value = 0.0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    const bool is_number = error == std::errc{} && end == line.data() + line.size() && std::isfinite(value);
    if (is_number && value >= least && value <= most) return value;
  }
}

bool Dialog::confirm(const std::string& question) const {
  if (!has_person_) return takes_yes_;
  settings::write_at_once(question + " [y/N] ");
  const std::string answer = read_line();
  return answer == "y" || answer == "Y" || answer == "yes";
}

void Dialog::show(double elapsed_s, const std::string& values, bool is_last) {
  if (is_watched_) {
    fmt::print(stderr, "\r\x1b[K{}{}", values, is_last ? "\n" : "");
  } else if (is_last || elapsed_s >= next_line_s_) {
    fmt::print(stderr, "{}\n", values);
    next_line_s_ = elapsed_s + kLineInterval_s;
  }
  if (is_last) next_line_s_ = 0.0;
  std::fflush(stderr);
}

}  // namespace yuragi::daemon::tools::calibration
