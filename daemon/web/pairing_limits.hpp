#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace yuragi::daemon::web {

/// Which attempts to pair are allowed: kBurst of an address at once and then one a second, so that one who guesses does
/// not lock others out. Memory is bounded: beyond kMaxAddresses, new addresses share one allowance.
/// Time is a parameter, of a clock that is never set. Thread-safe: no.
class PairingLimits {
 public:
  static constexpr double kBurst = 10.0;
  static constexpr std::size_t kMaxAddresses = 1024;

  /// Returns true, and counts the attempt, if `address` may try at `now_s`.
  bool take(const std::string& address, double now_s);

 private:
  struct Allowance {
    double left = kBurst;
    double at_s = 0.0;
  };

  std::map<std::string, Allowance> of_address_;
};

}  // namespace yuragi::daemon::web
