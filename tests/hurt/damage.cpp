#include "tests/hurt/damage.hpp"

#include <algorithm>

namespace yuragi::hurt {
namespace {

/// The largest count of each kind.
constexpr std::array<int, kDamageKinds> kMost = {5, 1, 5, 3, 3, 3, 1, 1};

void flip(char& byte, unsigned bits) {
  byte = static_cast<char>(static_cast<unsigned char>(byte) ^ bits);
}

void hurt_once(std::string& message, DamageKind kind, Chance& chance) {
  if (message.empty()) return;
  const std::size_t at = chance.below(message.size());
  switch (kind) {
    case DamageKind::kBits:
      flip(message[at], 1U << chance.below(8));
      break;
    case DamageKind::kBurst:
      flip(message[at], chance.byte());
      if (at + 1 < message.size()) flip(message[at + 1], chance.byte());
      break;
    case DamageKind::kBytes:
      message[at] = static_cast<char>(chance.byte());
      break;
    case DamageKind::kLost:
      message.erase(at, 1);
      break;
    case DamageKind::kAdded:
      message.insert(at, 1, static_cast<char>(chance.byte()));
      break;
    case DamageKind::kDoubled:
      message.insert(at, 1, message[at]);
      break;
    case DamageKind::kCut:
    case DamageKind::kSpliced:
      message.resize(at);
      break;
  }
}

}  // namespace

Damage any_damage(Chance& chance) {
  const std::size_t kind = chance.below(kDamageKinds);
  return {.kind = static_cast<DamageKind>(kind), .count = chance.between(1, kMost[kind])};
}

std::string hurt(std::string message, std::string_view other, const Damage& damage, Chance& chance) {
  for (int i = 0; i < damage.count; ++i) hurt_once(message, damage.kind, chance);
  if (damage.kind == DamageKind::kSpliced) message += other.substr(std::min(message.size(), other.size()));
  return message;
}

}  // namespace yuragi::hurt
