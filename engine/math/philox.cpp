#include "engine/math/philox.hpp"

#include <cmath>
#include <numbers>

namespace yuragi::math {
namespace {

constexpr std::uint32_t low(std::uint64_t word) {
  return static_cast<std::uint32_t>(word);
}
constexpr std::uint32_t high(std::uint64_t word) {
  return static_cast<std::uint32_t>(word >> 32U);
}

/// The top 53 bits of 64 as a number in [0, 1).
double to_unit(std::uint32_t low_word, std::uint32_t high_word) {
  const std::uint64_t word = (std::uint64_t{high_word} << 32U) | low_word;
  return static_cast<double>(word >> 11U) * 0x1p-53;
}

}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) noexcept {
  // Multipliers and key increments of table 2 (the golden ratio and sqrt(3) - 1).
  constexpr std::uint64_t kMultiplier0 = 0xD2511F53U;
  constexpr std::uint64_t kMultiplier1 = 0xCD9E8D57U;
  constexpr std::uint32_t kWeyl0 = 0x9E3779B9U;
  constexpr std::uint32_t kWeyl1 = 0xBB67AE85U;

  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product0 = kMultiplier0 * counter[0];
    const std::uint64_t product1 = kMultiplier1 * counter[2];
    counter = {high(product1) ^ counter[1] ^ key[0], low(product1), high(product0) ^ counter[3] ^ key[1],
               low(product0)};
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return counter;
}

std::array<double, 2> RandomStream::uniform_pair(std::uint64_t pair) const noexcept {
  const auto words = philox4x32({low(pair), high(pair), low(stream_), high(stream_)}, {low(seed_), high(seed_)});
  return {to_unit(words[0], words[1]), to_unit(words[2], words[3])};
}

std::array<double, 2> RandomStream::normal_pair(std::uint64_t pair) const noexcept {
  const auto [first, second] = uniform_pair(pair);
  // 1 - first is in (0, 1]: the logarithm is finite.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - first));
  const double angle_rad = 2.0 * std::numbers::pi * second;
  return {radius * std::cos(angle_rad), radius * std::sin(angle_rad)};
}

}  // namespace yuragi::math
