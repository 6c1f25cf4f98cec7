#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi::simulators::core {

/// The faults that can be played. No simulator can play all of them: each lists its own (Simulator::known_faults).
enum class FaultKind : std::uint8_t {
  kSilence,           ///< receives, and sends nothing
  kFreeze,            ///< repeats its last values
  kSpike,             ///< reports 55 m/s, which a wind can reach, but not from one moment to the next
  kGarbage,           ///< sends random bytes
  kSplit,             ///< sends the right bytes in pieces, with pauses between them
  kPartial,           ///< stops before the end of a message
  kBadChecksum,       ///< sends a whole message with a wrong checksum
  kWrongId,           ///< replies with the id of another device
  kWrongTransaction,  ///< replies to the request before this one
  kLate,              ///< replies after the client's time-out
  kException,         ///< replies with an error: a Modbus exception, HTTP 503
  kDisconnect,        ///< closes its connections and accepts no new ones
  kUnplug,            ///< removes the device (port, socket, place on the bus) and restores it afterwards
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

/// What goes wrong with one simulated sensor, and when. Of several faults that overlap, the one that began last is
/// played. Thread-safe: no.
class Faults {
 public:
  /// `known`: the faults that this simulator can play; must outlive this.
  explicit Faults(std::span<const FaultKind> known) : known_(known) {}

  void add(const Fault& fault) { faults_.push_back(fault); }
  void add(const RandomFaults& random) { random_ = random; }
  void clear();

  /// The fault of a moment.
  std::optional<FaultKind> at(double time_s) const;

  /// Reads "silence@10+5": from second 10 on, for 5 s; or durations with their units: "silence@5min+30s". The failure's
  /// text is what is allowed.
  Result<Fault, Failure> parse(std::string_view text) const;

  /// Carries out a command typed at `time_s`: a kind and a duration ("silence 5", "silence 2min"; 3 s if none is
  /// given), "clear" or "help". Returns the text to print.
  std::string obey(std::string_view line, double time_s);

 private:
  std::optional<FaultKind> kind_named(std::string_view name) const;
  std::optional<Fault> random_at(double time_s) const;
  std::string kinds() const;

  std::span<const FaultKind> known_;
  std::vector<Fault> faults_;
  std::optional<RandomFaults> random_;
};

}  // namespace yuragi::simulators::core
