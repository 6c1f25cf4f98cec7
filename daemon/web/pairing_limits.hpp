#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace yuragi::daemon::web {

/// Which attempts to pair are allowed: kBurst of an address at once and then one a second, so that one who guesses does
/// not lock others out, and each code once. Memory is bounded: beyond kMaxAddresses, new addresses share one allowance.
/// Time is a parameter, of a clock that is never set. Thread-safe: no.
class PairingLimits {
 public:
  static constexpr double kBurst = 10.0;
  static constexpr std::size_t kMaxAddresses = 1024;

  /// Returns true, and counts the attempt, if `address` may try at `now_s`.
  bool take(const std::string& address, double now_s);

  /// Returns false if the code of this step (Access::pairing_step_of()) was used before. Later steps are larger.
  bool use(std::int64_t step);

 private:
  struct Allowance {
    double left = kBurst;
    double at_s = 0.0;
  };

  std::map<std::string, Allowance> of_address_;
  std::set<std::int64_t> used_;
};

}  // namespace yuragi::daemon::web
