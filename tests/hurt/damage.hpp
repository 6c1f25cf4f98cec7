#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>

namespace yuragi::hurt {

/// The same numbers on every machine.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : random_(seed) {}

  std::uint8_t byte() { return static_cast<std::uint8_t>(random_()); }
  /// 0 to `below` - 1.
  std::size_t below(std::size_t below) { return static_cast<std::size_t>(random_() % below); }
  /// `least` to `most`.
  int between(int least, int most) {
    return least + static_cast<int>(below(static_cast<std::size_t>(most - least) + 1));
  }

 private:
  std::mt19937_64 random_;
};

/// The ways in which messages are hurt: by noise on a line, by a receiver that loses bytes or its place, by a sender
/// that was cut off.
enum class DamageKind : std::uint8_t {
  kBits,     ///< 1 to 5 bits, flipped; two flips of one bit undo each other
  kBurst,    ///< two bytes side by side, of any value
  kBytes,    ///< 1 to 5 bytes, of any value
  kLost,     ///< 1 to 3 bytes, left out
  kAdded,    ///< 1 to 3 bytes of any value
  kDoubled,  ///< 1 to 3 bytes that come twice
  kCut,      ///< the end is missing
  kSpliced,  ///< the beginning of one message, and the end of another
};
inline constexpr std::size_t kDamageKinds = 8;

struct Damage {
  DamageKind kind = DamageKind::kBits;
  int count = 1;  ///< of bits or bytes
};

/// Any damage, each kind as often.
Damage any_damage(Chance& chance);

/// `message`, hurt so. `other` is the one whose end follows where two are spliced. Neither is empty.
std::string hurt(std::string message, std::string_view other, const Damage& damage, Chance& chance);

}  // namespace yuragi::hurt
