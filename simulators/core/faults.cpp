#include "simulators/core/faults.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "engine/base/duration.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::simulators::core {
namespace {

constexpr double kDefaultDuration_s = 3.0;

std::optional<double> time_in(std::string_view text) {
  if (text.find(' ') != std::string_view::npos) return std::nullopt;
  const auto time_s = parse_duration_s(text);
  return time_s ? std::optional(*time_s) : std::nullopt;
}

}  // namespace

std::string_view name_of(FaultKind kind) {
  return kFaultNames[static_cast<std::size_t>(kind)];
}

void Faults::clear() {
  faults_.clear();
  random_.reset();
}

std::optional<FaultKind> Faults::at(double time_s) const {
  std::optional<Fault> latest = random_at(time_s);
  for (const Fault& fault : faults_) {
    const bool holds = time_s >= fault.start_s && time_s < fault.start_s + fault.duration_s;
    if (holds && (!latest || fault.start_s >= latest->start_s)) latest = fault;
  }
  return latest ? std::optional(latest->kind) : std::nullopt;
}

std::optional<Fault> Faults::random_at(double time_s) const {
  if (!random_ || known_.empty() || time_s < 0.0) return std::nullopt;
  // Two random numbers for each interval: one for the beginning of its fault, one for the kind.
  const double stretch = std::floor(time_s / random_->every_s);
  const auto [when, what] =
      math::RandomStream(random_->seed, math::stream_id("faults")).uniform_pair(static_cast<std::uint64_t>(stretch));
  const double slack_s = random_->every_s - random_->duration_s;
  const Fault fault{.kind = known_[static_cast<std::size_t>(what * static_cast<double>(known_.size()))],
                    .start_s = stretch * random_->every_s + when * slack_s,
                    .duration_s = random_->duration_s};
  const bool holds = time_s >= fault.start_s && time_s < fault.start_s + fault.duration_s;
  return holds ? std::optional(fault) : std::nullopt;
}

Result<Fault, Failure> Faults::parse(std::string_view text) const {
  const std::size_t at = text.find('@');
  const std::size_t plus = text.find('+', at == std::string_view::npos ? text.size() : at);
  if (plus != std::string_view::npos) {
    const auto kind = kind_named(text.substr(0, at));
    const auto start_s = time_in(text.substr(at + 1, plus - at - 1));
    const auto duration_s = time_in(text.substr(plus + 1));
    if (kind && start_s && duration_s) return Fault{*kind, *start_s, *duration_s};
  }
  return Failure{
      fmt::format("\"{}\" is not a fault; allowed: KIND@START+DURATION, such as silence@10+5 (seconds) or "
                  "unplug@5min+30s, with KIND "
                  "one of {}",
                  text, kinds())};
}

std::string Faults::obey(std::string_view line, double time_s) {
  std::istringstream words{std::string(line)};
  std::string word, duration;
  words >> word >> duration;

  if (word.empty()) return "";
  if (word == "clear") {
    clear();
    return "no faults";
  }
  const auto kind = kind_named(word);
  const auto duration_s = duration.empty() ? std::optional(kDefaultDuration_s) : time_in(duration);
  if (!kind || !duration_s) return fmt::format("allowed: KIND [TIME], with KIND one of {}; or clear", kinds());
  add(Fault{*kind, time_s, *duration_s});
  return fmt::format("{} for {:g} s", word, *duration_s);
}

std::optional<FaultKind> Faults::kind_named(std::string_view name) const {
  const auto found = std::ranges::find(known_, name, [](FaultKind kind) { return name_of(kind); });
  return found != known_.end() ? std::optional(*found) : std::nullopt;
}

std::string Faults::kinds() const {
  std::string all;
  for (const FaultKind kind : known_) all += fmt::format("{}{}", all.empty() ? "" : ", ", name_of(kind));
  return all;
}

}  // namespace yuragi::simulators::core
