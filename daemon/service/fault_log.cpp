#include "daemon/service/fault_log.hpp"

#include <fmt/format.h>

#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::service {
namespace {

constexpr stream::LogAllowance::Settings kOneEachInterval{
    .burst = 1.0,
    .per_s = 1.0 / std::chrono::duration<double>(FaultLog::kInterval).count(),
    .told_every = Nanoseconds::zero()};

}  // namespace

std::optional<std::string> FaultLog::line_for(std::string_view kind, std::string_view what, MonoTime now) {
  if (counts_.size() >= kMaxKinds && !counts_.contains(kind)) kind = kOtherKind;
  ++counts_.try_emplace(std::string(kind)).first->second;
  auto found = allowances_.find(kind);
  if (found == allowances_.end()) found = allowances_.emplace(kind, stream::LogAllowance(kOneEachInterval, now)).first;
  stream::LogAllowance& allowance = found->second;
  if (!allowance.take(now)) return std::nullopt;
  const std::uint64_t left_out = allowance.tell_left_out(now);
  const std::string since = left_out > 0 ? fmt::format(" ({} more since the last such line)", left_out) : "";
  std::string text(what);
  make_printable(text);
  return fmt::format("{} failed: {}{}; this is a fault of the program", kind, text, since);
}

}  // namespace yuragi::daemon::service
