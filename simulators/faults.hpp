#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi::sim {

/// What can be made to go wrong.
enum class FaultKind : std::uint8_t {
  kSilence,           ///< hears, and does not answer
  kException,         ///< answers with a Modbus exception
  kWrongId,           ///< answers as another device
  kWrongTransaction,  ///< answers the request before this one
  kShort,             ///< stops before the end of an answer
  kGarbage,           ///< answers with random bytes
  kDrop,              ///< closes its connections and takes no new ones
};
inline constexpr std::array<std::string_view, 7> kFaultNames = {"silence", "exception", "wrong-id", "wrong-transaction",
                                                                "short",   "garbage",   "drop"};

struct Fault {
  FaultKind kind = FaultKind::kSilence;
  double start_s = 0.0;
  double duration_s = 0.0;
};

/// Faults by time. Where several overlap, the one that began last holds. Thread-safe: no.
class Faults {
 public:
  void add(const Fault& fault) { faults_.push_back(fault); }
  void clear() { faults_.clear(); }

  /// The fault of a moment.
  std::optional<FaultKind> at(double time_s) const;

 private:
  std::vector<Fault> faults_;
};

/// Reads "silence@10+5": from second 10 on, for 5 s. The failure says what is allowed.
Result<Fault, Failure> parse_fault(std::string_view text);

/// Obeys a line that somebody typed at `time_s`: a kind and for how long ("silence 5"; 3 s if nothing is said), "clear"
/// or "help". Returns what to answer.
std::string obey(Faults& faults, std::string_view line, double time_s);

}  // namespace yuragi::sim
