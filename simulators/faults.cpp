#include "simulators/faults.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

namespace yuragi::sim {
namespace {

constexpr double kDefaultDuration_s = 3.0;

std::optional<FaultKind> kind_named(std::string_view name) {
  const auto found = std::ranges::find(kFaultNames, name);
  if (found == kFaultNames.end()) return std::nullopt;
  return static_cast<FaultKind>(found - kFaultNames.begin());
}

std::optional<double> time_in(std::string_view text) {
  double value_s = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value_s);
  const bool is_time =
      error == std::errc{} && end == text.data() + text.size() && std::isfinite(value_s) && value_s >= 0.0;
  return is_time ? std::optional(value_s) : std::nullopt;
}

std::string kinds() {
  return fmt::format("{}", fmt::join(kFaultNames, ", "));
}

}  // namespace

std::optional<FaultKind> Faults::at(double time_s) const {
  const Fault* latest = nullptr;
  for (const Fault& fault : faults_) {
    const bool holds = time_s >= fault.start_s && time_s < fault.start_s + fault.duration_s;
    if (holds && (latest == nullptr || fault.start_s >= latest->start_s)) latest = &fault;
  }
  return latest != nullptr ? std::optional(latest->kind) : std::nullopt;
}

Result<Fault, Failure> parse_fault(std::string_view text) {
  const std::size_t at = text.find('@');
  const std::size_t plus = text.find('+', at == std::string_view::npos ? text.size() : at);
  if (plus != std::string_view::npos) {
    const auto kind = kind_named(text.substr(0, at));
    const auto start_s = time_in(text.substr(at + 1, plus - at - 1));
    const auto duration_s = time_in(text.substr(plus + 1));
    if (kind && start_s && duration_s) return Fault{*kind, *start_s, *duration_s};
  }
  return Failure{fmt::format(
      "\"{}\" is no fault; allowed: KIND@START+DURATION in seconds, such as silence@10+5, with KIND one of {}", text,
      kinds())};
}

std::string obey(Faults& faults, std::string_view line, double time_s) {
  std::istringstream words{std::string(line)};
  std::string word, duration;
  words >> word >> duration;

  if (word.empty()) return "";
  if (word == "clear") {
    faults.clear();
    return "no faults";
  }
  const auto kind = kind_named(word);
  const auto duration_s = duration.empty() ? std::optional(kDefaultDuration_s) : time_in(duration);
  if (!kind || !duration_s) return fmt::format("say KIND [SECONDS], with KIND one of {}; or clear", kinds());
  faults.add({*kind, time_s, *duration_s});
  return fmt::format("{} for {:g} s", word, *duration_s);
}

}  // namespace yuragi::sim
