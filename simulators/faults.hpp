#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi::sim {

/// What can be made to go wrong. No simulator suffers all of it: each says which of these it knows.
enum class FaultKind : std::uint8_t {
  kSilence,           ///< hears, and says nothing
  kFreeze,            ///< says what it said last, again and again
  kSpike,             ///< says 55 m/s, which a wind can reach, but not from one moment to the next
  kGarbage,           ///< says random bytes
  kSplit,             ///< says the right bytes in pieces, with pauses between them
  kPartial,           ///< stops before the end of what it says
  kBadChecksum,       ///< says all, with a wrong checksum
  kWrongId,           ///< answers as another device
  kWrongTransaction,  ///< answers the request before this one
  kLate,              ///< answers when nobody waits any more
  kException,         ///< answers with a Modbus exception
  kDisconnect,        ///< closes its connections and takes no new ones
  kUnplug,            ///< the device is gone: its port, its socket, its place on the bus; plugged in again afterwards
};
inline constexpr std::array<std::string_view, 13> kFaultNames = {
    "silence",           "freeze", "spike",     "garbage",    "split", "partial", "bad-checksum", "wrong-id",
    "wrong-transaction", "late",   "exception", "disconnect", "unplug"};

std::string_view name_of(FaultKind kind);

struct Fault {
  FaultKind kind = FaultKind::kSilence;
  double start_s = 0.0;
  double duration_s = 0.0;
};

/// Faults at random: one in each stretch of `every_s` seconds, whose kind and beginning follow from the seed.
struct RandomFaults {
  double every_s = 60.0;  ///< above `duration_s`
  double duration_s = 5.0;
  std::uint64_t seed = 1;
};

/// What goes wrong with one simulated sensor, and when. Where several faults overlap, the one that began last holds.
/// Thread-safe: no.
class Faults {
 public:
  /// `known`: what this simulator can suffer; must outlive this.
  explicit Faults(std::span<const FaultKind> known) : known_(known) {}

  void add(const Fault& fault) { faults_.push_back(fault); }
  void add(const RandomFaults& random) { random_ = random; }
  void clear();

  /// The fault of a moment.
  std::optional<FaultKind> at(double time_s) const;

  /// Reads "silence@10+5": from second 10 on, for 5 s. The failure says what is allowed.
  Result<Fault, Failure> parse(std::string_view text) const;

  /// Obeys a line that somebody typed at `time_s`: a kind and for how long ("silence 5"; 3 s if nothing is said),
  /// "clear" or "help". Returns what to answer.
  std::string obey(std::string_view line, double time_s);

 private:
  std::optional<FaultKind> kind_named(std::string_view name) const;
  std::optional<Fault> random_at(double time_s) const;
  std::string kinds() const;

  std::span<const FaultKind> known_;
  std::vector<Fault> faults_;
  std::optional<RandomFaults> random_;
};

}  // namespace yuragi::sim
