#include "daemon/service/fault_log.hpp"

#include <fmt/format.h>

#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::service {
namespace {

constexpr stream::LogAllowance::Settings kOneEachInterval{
    .burst = 1.0,
    .per_s = 1.0 / std::chrono::duration<double>(FaultLog::kInterval).count(),
    .report_every = Nanoseconds::zero()};

}  // namespace

std::optional<std::string> FaultLog::line_for(std::string_view kind, std::string_view what, MonoTime now) {
  if (kinds_.size() >= kMaxKinds && !kinds_.contains(kind)) kind = kOtherKind;
  auto found = kinds_.find(kind);
  if (found == kinds_.end()) found = kinds_.emplace(kind, Kind{0, stream::LogAllowance(kOneEachInterval, now)}).first;
  auto& [count, allowance] = found->second;
  ++count;
  if (!allowance.take(now)) return std::nullopt;
  const std::uint64_t left_out = allowance.take_left_out(now);
  const std::string since = left_out > 0 ? fmt::format(" ({} more since the last such line)", left_out) : "";
  std::string text(what);
  make_printable(text);
  return fmt::format("{} failed: {}{}; this is a fault of the program, please report it", kind, text, since);
}

web::FaultCounts FaultLog::counts() const {
  web::FaultCounts counts;
  for (const auto& [name, kind] : kinds_) counts.emplace(name, kind.count);
  return counts;
}

}  // namespace yuragi::daemon::service
