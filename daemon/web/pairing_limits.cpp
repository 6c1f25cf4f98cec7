#include "daemon/web/pairing_limits.hpp"

#include <algorithm>

namespace yuragi::daemon::web {

bool PairingLimits::take(const std::string& address, double now_s) {
  const auto left_now = [now_s](const Allowance& allowance) {
    return std::min(kBurst, allowance.left + std::max(0.0, now_s - allowance.at_s));
  };
  const auto is_full = [&] { return of_address_.size() >= kMaxAddresses && !of_address_.contains(address); };
  if (is_full()) std::erase_if(of_address_, [&](const auto& one) { return left_now(one.second) >= kBurst; });
  Allowance& allowance = of_address_.try_emplace(is_full() ? std::string() : address).first->second;
  const double left = left_now(allowance);
  const bool is_allowed = left >= 1.0;
  allowance = {.left = is_allowed ? left - 1.0 : left, .at_s = now_s};
  return is_allowed;
}

}  // namespace yuragi::daemon::web
